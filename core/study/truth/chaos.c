// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/chaos.h"

#include "base/clock.h"
#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "study/truth/errors.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WINDOWS = 16 };     // at least
#define LONGEST_WINDOW 0.5 // [s]
// of a radian, or of the scene's length: far above the integrator's error, far below what bends the
// line
#define APART 1e-7
#define METHOD "projection@dop853:rtol=1e-11"

typedef struct twins {
    const hn_system *sys;
    hn_system_info info;
    hn_method_spec spec;
    hn_arena *arena;
    hn_errors *errors;
    hn_projector *projector;
    hn_scales scales;
    const hn_walk_limits *limits;
    double started;
    double *q, *v;           ///< (windows + 1) states of the one motion, user coordinates
    double *twin_q, *twin_v; ///< of the other, user coordinates
    double *sys_q, *sys_v, *from, *delta, *user;
} twins;

static hn_status ended(const hn_run *run, hn_diag *diag) {
    const hn_run_summary s = hn_run_get_summary(run);
    return hn_diag_set(diag, HN_ERR_NO_CONVERGENCE, NULL, NULL,
                       "neighbouring motions could only be followed to t = %.4g s: %s", s.t,
                       s.reason);
}

/// From one state (user coordinates) over dt; the end in its place.
static hn_status follow(twins *w, double t, double dt, double *q, double *v, hn_diag *diag) {
    hn_run *run = NULL;
    hn_sample sample;
    hn_run_opts opts = hn_run_opts_default();
    opts.t0 = t;
    hn_system_from_user(w->sys, q, w->sys_q);
    hn_system_rates_from_user(w->sys, v, w->sys_v);
    hn_status status = hn_run_create(w->sys, &w->spec, w->sys_q, w->sys_v, &opts, &run, diag);
    if (status != HN_OK) {
        return status;
    }
    hn_run_watch(run, 0);
    if (hn_run_advance(run, t + dt) != HN_OK || hn_run_sample(run, t + dt, &sample) != HN_OK) {
        status = ended(run, diag);
    } else {
        memcpy(q, sample.q, (size_t)w->info.n_user * sizeof *q);
        memcpy(v, sample.v, (size_t)w->info.n_user * sizeof *v);
    }
    hn_run_free(run);
    return status;
}

static double distance(twins *w, const double *q, const double *v, const double *other_q,
                       const double *other_v) {
    return hypot(hn_errors_between(w->errors, q, other_q),
                 hn_errors_between_rates(w->errors, v, other_v, &w->scales));
}

/// Moves the twin to `factor` times its distance from (q, v), on closed loops; *apart: the distance
/// that it then has.
static hn_status bring_near(twins *w, double t, const double *q, const double *v, double factor,
                            double *apart) {
    const int n = w->info.n_user;

    // scale the differences of positions and velocities by the factor
    hn_system_from_user(w->sys, q, w->from);
    hn_system_from_user(w->sys, w->twin_q, w->sys_q);
    hn_system_difference(w->sys, w->from, w->sys_q, w->delta);
    for (int i = 0; i < w->info.nv; i++) {
        w->delta[i] *= factor;
    }
    hn_system_move(w->sys, w->from, w->delta);
    for (int i = 0; i < n; i++) {
        w->user[i] = v[i] + factor * (w->twin_v[i] - v[i]);
    }
    hn_system_rates_from_user(w->sys, w->user, w->sys_v);

    // onto the closed loops
    HN_TRY(hn_project_position(w->projector, t, w->from, 1e-14, NULL));
    HN_TRY(hn_project_velocity(w->projector, t, w->from, w->sys_v, NULL));

    // distance after the projection
    hn_system_to_user(w->sys, w->from, w->twin_q);
    hn_system_rates_to_user(w->sys, w->sys_v, w->twin_v);
    *apart = distance(w, q, v, w->twin_q, w->twin_v);
    return HN_OK;
}

/// Sets the twin apart from the start, in a direction that belongs to no symmetry of a mechanism.
static void set_apart(twins *w) {
    for (int i = 0; i < w->info.n_user; i++) {
        w->twin_q[i] = w->q[i] + 1e-3 * sin(1 + 2.3 * i) * w->scales.length;
        w->twin_v[i] = w->v[i] + 1e-3 * cos(2 + 1.7 * i) * w->scales.length * w->scales.rate;
    }
}

static hn_status asked(const twins *w, hn_diag *diag) {
    const hn_walk_limits *l = w->limits;
    const int stop = (l && l->stop && l->stop(l->user)) ||
                     (l && l->seconds > 0 && hn_clock_thread() - w->started > l->seconds);
    return stop ? hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "stopped on request") : HN_OK;
}

/// The one motion, window by window, and the fastest rate on it.
static hn_status follow_one(twins *w, hn_chaos *out, hn_diag *diag) {
    const size_t n = (size_t)w->info.n_user;
    hn_status status = HN_OK;
    w->scales.rate = fmax(1 / out->T, hn_errors_rate(w->errors, w->v));
    for (int k = 0; status == HN_OK && k < out->windows; k++) {
        double *q = w->q + (size_t)(k + 1) * n, *v = w->v + (size_t)(k + 1) * n;
        memcpy(q, q - n, n * sizeof *q);
        memcpy(v, v - n, n * sizeof *v);
        status = asked(w, diag);
        status = status == HN_OK ? follow(w, k * out->window, out->window, q, v, diag) : status;
        w->scales.rate = fmax(w->scales.rate, hn_errors_rate(w->errors, v));
    }
    return status;
}

static hn_status follow_twin(twins *w, hn_chaos *out, hn_diag *diag) {
    const size_t n = (size_t)w->info.n_user;
    double apart = 0;
    set_apart(w);
    hn_status status = bring_near(w, 0, w->q, w->v, APART / 1e-3, &apart);
    for (int k = 0; status == HN_OK && k < out->windows; k++) {
        const double *q = w->q + (size_t)(k + 1) * n, *v = w->v + (size_t)(k + 1) * n;
        status = asked(w, diag);
        status = status == HN_OK
                     ? follow(w, k * out->window, out->window, w->twin_q, w->twin_v, diag)
                     : status;
        if (status != HN_OK) {
            break;
        }
        const double grown = distance(w, q, v, w->twin_q, w->twin_v);
        double *growth = 2 * k < out->windows ? &out->growth_first : &out->growth;
        *growth += log(grown / apart);
        status = bring_near(w, (k + 1) * out->window, q, v, APART / grown, &apart);
    }
    return status;
}

static void judge(hn_chaos *c) {
    const double half = c->T / 2;
    c->exponent = c->growth / half;
    c->chaotic = c->growth > HN_CHAOS_PARTING;
    snprintf(c->why, sizeof c->why,
             c->chaotic ? "chaotic: between %.3g and %.3g s neighbouring motions part by a factor "
                          "%.3g, e-fold every %.3g s"
                        : "not chaotic: between %.3g and %.3g s neighbouring motions part by a "
                          "factor %.3g",
             half, c->T, exp(c->growth), 1 / c->exponent);
}

static hn_status create(twins *w, const double *q, const double *v, int windows) {
    const size_t n = (size_t)w->info.n_user, nq = (size_t)w->info.nq, nv = (size_t)w->info.nv;
    hn_diag diag;
    w->q = hn_arena_doubles(w->arena, (size_t)(windows + 1) * n);
    w->v = hn_arena_doubles(w->arena, (size_t)(windows + 1) * n);

    double **vectors[] = {&w->twin_q, &w->twin_v, &w->sys_v, &w->delta, &w->user};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = hn_arena_doubles(w->arena, nv);
    }
    w->sys_q = hn_arena_doubles(w->arena, nq);
    w->from = hn_arena_doubles(w->arena, nq);

    if (hn_arena_failed(w->arena)) {
        return HN_ERR_MEMORY;
    }

    // the start, and the evaluators of distances and projections
    hn_system_to_user(w->sys, q, w->q);
    hn_system_rates_to_user(w->sys, v, w->v);
    // states are compared in user units; hn_errors scales lengths itself
    w->scales.length = 1;
    HN_TRY(hn_errors_create(w->sys, w->arena, &w->errors));
    HN_TRY(hn_projector_create(w->sys, HN_WEIGHT_MASS, w->arena, &w->projector));
    return hn_method_parse(METHOD, &w->spec, &diag);
}

/// Returns 1 where the motion can be chaotic: with two degrees of freedom or more, or with one and
/// an explicit dependence on time. Otherwise out->why has the reason, or *status the failure.
static bool is_possible(const hn_system *sys, const double *q, const double *v, hn_chaos *out,
                        hn_diag *diag, hn_status *status) {
    hn_run *run = NULL;
    hn_sample s;
    hn_method_spec spec;
    const hn_run_opts opts = hn_run_opts_default();
    const hn_system_info info = hn_system_get_info(sys);

    *status = hn_method_parse(METHOD, &spec, diag);
    if (*status == HN_OK) {
        *status = hn_run_create(sys, &spec, q, v, &opts, &run, diag);
    }

    // degrees of freedom at the start, by the rank of J
    if (*status == HN_OK) {
        *status = hn_run_sample(run, 0, &s);
        const int freedoms = *status == HN_OK ? info.nv - s.rank : 0;
        out->possible = freedoms > 1 || (freedoms == 1 && info.has_time);
        if (!out->possible) {
            snprintf(out->why, sizeof out->why, "not chaotic: %s",
                     freedoms == 1
                         ? "one degree of freedom without explicit time dependence allows no chaos"
                         : "no degree of freedom is left");
        }
    }

    hn_run_free(run);
    return *status == HN_OK && out->possible;
}

hn_status hn_chaos_estimate(const hn_system *sys, const double *q, const double *v, double T,
                            const hn_walk_limits *limits, hn_chaos *out, hn_diag *diag) {
    hn_status status;
    *out = (hn_chaos){.T = T};

    if (!(T > 0) || !isfinite(T)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/time", NULL,
                           "the end must lie after 0, not at %g s", T);
    }
    if (!is_possible(sys, q, v, out, diag, &status)) {
        return hn_system_stopped(sys, status, diag);
    }

    // an even number of windows: the two halves of the time are compared
    const double least = ceil(T / LONGEST_WINDOW);
    out->windows = least > 1e4 ? 10000 : least < WINDOWS ? WINDOWS : (int)least + (int)least % 2;
    out->window = T / out->windows;

    // the motion, its twin, and the verdict
    twins w = {.sys = sys,
               .info = hn_system_get_info(sys),
               .limits = limits,
               .started = hn_clock_thread()};
    w.arena = hn_arena_create(1 << 14);
    status = w.arena ? create(&w, q, v, out->windows) : HN_ERR_MEMORY;
    HN_THEN(status, follow_one(&w, out, diag));
    HN_THEN(status, follow_twin(&w, out, diag));
    if (status == HN_OK) {
        judge(out);
    }

    hn_errors_free(w.errors);
    hn_projector_free(w.projector);
    hn_arena_free(w.arena);
    return hn_system_stopped(sys, status, diag);
}

double hn_chaos_horizon(const hn_chaos *chaos, double small, double large) {
    return chaos->chaotic && small > 0 && large > small ? log(large / small) / chaos->exponent
                                                        : HUGE_VAL;
}
