// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/precise.h"

#include "base/clock.h"
#include "dynamics/compile/coordinates.h"
#include "study/run/pace.h"
#include "study/truth/precise_solver.h"
#include "study/truth/precise_stepper.h"

#include <math.h>
#include <string.h>

/// Error of a step, relative to an angle of 1, the scene's length, and their rates. Accelerations
/// near a pose without full rank carry rounding over the square of what is left of it; where no
/// step gets past that, the whole is done again with the next.
static const hn_real TOLERANCES[] = {1e-17L, 1e-15L, 1e-13L};
enum { N_TOLERANCES = sizeof TOLERANCES / sizeof *TOLERANCES };
#define LEAST_STEP 1e-15L // of T: below it nothing is gained
#define FIRST_STEP 1e-3L  // of T
#define ALMOST 1.0001L    // a step that comes this close to a time that is looked at goes there

typedef struct precise {
    hn_precise_model *model;
    const hn_precise_solver *solver;
    const hn_precise_stepper *stepper;
    void *solving, *stepping;
    hn_precise_ode ode;
    hn_real t, h;
    hn_real *y, *scale, *lambda, *a; ///< y: q, then v
    hn_real rate;                    ///< largest speed so far, lengths over L [1/s]
    double *q, *v, *user_q, *user_v, *user_lambda;
    double started;
    hn_pace pace;
    const hn_walk_limits *limits;
} precise;

static const struct kind {
    const char *name;
    const hn_precise_solver *solver;
    const hn_precise_stepper *stepper;
} KINDS[] = {
    [HN_PRECISE_SADDLE] = {"saddle@extrapolation in long double", &hn_precise_saddle,
                           &hn_precise_extrapolation},
    [HN_PRECISE_NULLSPACE] = {"nullspace@gauss10 in long double", &hn_precise_nullspace,
                              &hn_precise_gauss},
};

const char *hn_precise_name(hn_precise_kind kind) {
    return KINDS[kind].name;
}

static hn_status rate_of(void *user, hn_real t, const hn_real *y, hn_real *dy) {
    precise *p = user;
    const int nq = p->model->nq;
    hn_precise_model_kinematics(p->model, y, y + nq, dy);
    return p->solver->accelerate(p->solving, t, y, y + nq, dy + nq, NULL);
}

// ---- creation ----

static hn_status create(precise *p, hn_precise_kind kind, const hn_system *sys, hn_arena *arena) {
    HN_TRY(hn_precise_model_create(sys, arena, &p->model));

    const size_t nq = (size_t)p->model->nq, nv = (size_t)p->model->nv, nc = (size_t)p->model->nc;

    // memory: the state in long double, samples in double
    p->solver = KINDS[kind].solver;
    p->stepper = KINDS[kind].stepper;
    p->y = hn_arena_reals(arena, nq + nv);
    p->scale = hn_arena_reals(arena, nq + nv);
    p->lambda = hn_arena_reals(arena, nc);
    p->a = hn_arena_reals(arena, nv);
    p->q = hn_arena_doubles(arena, nq);
    p->v = hn_arena_doubles(arena, nv);
    p->user_q = hn_arena_doubles(arena, nv);
    p->user_v = hn_arena_doubles(arena, nv);
    p->user_lambda = hn_arena_doubles(arena, nc);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // the solver of accelerations, and the stepper above it
    p->ode = (hn_precise_ode){p->model->nq + p->model->nv, rate_of, p, p->scale, TOLERANCES[0]};
    HN_TRY(p->solver->create(p->model, arena, &p->solving));
    return p->stepper->create(&p->ode, arena, &p->stepping);
}

/// Starts at (q, v), projected onto closed loops, and sets the rate that velocities are scaled by.
static hn_status start(precise *p, const double *q, const double *v, double T) {
    const int nq = p->model->nq, nv = p->model->nv;

    // the state in long double, projected onto closed loops
    for (int i = 0; i < nq; i++) {
        p->y[i] = (hn_real)q[i];
    }
    for (int i = 0; i < nv; i++) {
        p->y[nq + i] = (hn_real)v[i];
    }
    hn_precise_model_normalise(p->model, p->y);
    p->solver->choose_rows(p->solving, 0, p->y);
    hn_status status = p->solver->close(p->solving, 0, p->y, p->y + nq);
    HN_THEN(status, p->solver->accelerate(p->solving, 0, p->y, p->y + nq, p->a, NULL));

    // the fastest rate of the motion, from its accelerations
    p->rate = 1 / (hn_real)T;
    for (int i = 0; status == HN_OK && i < nv; i++) {
        p->rate = fmaxl(p->rate, sqrtl(fabsl(p->a[i]) / p->model->floor[i]));
    }

    p->h = FIRST_STEP * (hn_real)T;
    p->t = 0;
    p->stepper->forget(p->stepping);
    return status;
}

static void set_scale(precise *p) {
    const hn_precise_model *m = p->model;
    for (int i = 0; i < m->nv; i++) {
        p->rate = fmaxl(p->rate, fabsl(p->y[m->nq + i]) / m->floor[i]);
    }
    for (int i = 0; i < m->nq; i++) {
        p->scale[i] = 1;
    }
    for (int i = 0; i < m->nv; i++) {
        if (m->floor[i] != 1) { // a length; entries of quaternions are at most 1 as they are
            p->scale[m->position[i]] = m->floor[i];
        }
        p->scale[m->nq + i] = p->rate * m->floor[i];
    }
    for (int i = 0; i < m->nq; i++) {
        p->scale[i] = fmaxl(p->scale[i], fabsl(p->y[i]));
    }
}

// ---- walking ----

static hn_walk_end asked_to_end(precise *p) {
    return hn_pace_is_due(&p->pace) ? hn_walk_ask(p->limits, p->started) : HN_WALK_DONE;
}

/// One step towards `t`, closed.
static hn_status step(precise *p, hn_real t, hn_real least) {
    const int nq = p->model->nq;
    const hn_real rest = t - p->t, wanted = p->h;
    const int lands = wanted * ALMOST >= rest;
    hn_real h = lands ? rest : wanted, taken = 0;
    set_scale(p);
    p->solver->choose_rows(p->solving, p->t, p->y);
    hn_status status =
        p->stepper->step(p->stepping, p->t, p->y, fminl(least, rest / 2), &h, &taken);
    if (status != HN_OK) {
        return status;
    }
    // a step that was cut short to land says nothing against the length that was wanted
    p->h = taken == rest && lands ? fmaxl(h, fminl(wanted, p->h)) : h;
    p->t = taken == rest ? t : p->t + taken;
    hn_precise_model_normalise(p->model, p->y);
    return p->solver->close(p->solving, p->t, p->y, p->y + nq);
}

/// Steps to `t`, and no step across a corner.
static hn_walk_end walk_to(precise *p, double t, hn_real least, hn_status *status) {
    while (p->t < (hn_real)t) {
        const double corner = hn_system_next_corner(p->model->sys, (double)p->t);
        const hn_real target = (hn_real)fmin(t, corner);
        const hn_walk_end end = asked_to_end(p);
        if (end != HN_WALK_DONE) {
            return end;
        }
        *status = step(p, target, least);
        if (*status != HN_OK) {
            return HN_WALK_FAILED;
        }
        if (p->t == (hn_real)corner) {
            p->stepper->forget(p->stepping);
        }
    }
    return HN_WALK_DONE;
}

static hn_status sample(precise *p, double t, hn_sample *out) {
    const hn_precise_model *m = p->model;

    // accelerations, multipliers and energy at the state reached
    p->solver->choose_rows(p->solving, p->t, p->y);
    const hn_status status =
        p->solver->accelerate(p->solving, p->t, p->y, p->y + m->nq, p->a, p->lambda);
    hn_precise_model_energy(p->model, p->t, p->y, p->y + m->nq);

    // in double and user coordinates
    for (int i = 0; i < m->nq; i++) {
        p->q[i] = (double)p->y[i];
    }
    for (int i = 0; i < m->nv; i++) {
        p->v[i] = (double)p->y[m->nq + i];
    }
    for (int i = 0; i < m->nc; i++) {
        p->user_lambda[i] = (double)p->lambda[i];
    }
    hn_system_to_user(m->sys, p->q, p->user_q);
    hn_system_rates_to_user(m->sys, p->v, p->user_v);

    *out = (hn_sample){.t = t,
                       .q = p->user_q,
                       .v = p->user_v,
                       .lambda = p->user_lambda,
                       .kinetic = (double)m->energy[0],
                       .potential = (double)m->energy[1],
                       .energy = (double)(m->energy[0] + m->energy[1])};
    return status;
}

static hn_walk_end walk(precise *p, double T, int n, hn_walk_see see, void *user,
                        hn_status *status) {
    for (int k = 0; k <= n; k++) {
        const double t = k == n ? T : T * k / n;
        hn_sample seen;
        const hn_walk_end end = walk_to(p, t, LEAST_STEP * (hn_real)T, status);
        if (end != HN_WALK_DONE) {
            return end;
        }
        *status = sample(p, t, &seen);
        if (*status != HN_OK || !see(user, k, &seen)) {
            *status = *status == HN_OK ? HN_ERR_DIVERGED : *status;
            return HN_WALK_FAILED;
        }
    }
    return HN_WALK_DONE;
}

hn_status hn_precise_walk(hn_precise_kind kind, const hn_system *sys, const double *q,
                          const double *v, double T, int n, const hn_walk_limits *limits,
                          hn_walk_see see, void *user, hn_walk_end *end, hn_diag *diag) {
    static const hn_walk_limits none;
    precise p = {
        .limits = limits ? limits : &none, .started = hn_clock_thread(), .pace = hn_pace_begin()};
    hn_arena *arena = hn_arena_create(0);
    hn_status status = arena ? create(&p, kind, sys, arena) : HN_ERR_MEMORY;
    const int made = status == HN_OK;
    *end = HN_WALK_FAILED;
    for (int i = 0; i < N_TOLERANCES && made && (i == 0 || *end == HN_WALK_FAILED); i++) {
        p.ode.tol = TOLERANCES[i];
        status = start(&p, q, v, T);
        *end = status == HN_OK ? walk(&p, T, n, see, user, &status) : HN_WALK_FAILED;
    }
    if (*end == HN_WALK_OVER || *end == HN_WALK_STOPPED) {
        status = HN_ERR_STOPPED;
    }
    if (status != HN_OK) {
        (void)hn_diag_set(diag, status, NULL, NULL, "at t = %.6g s: %s", (double)p.t,
                          *end == HN_WALK_OVER
                              ? "takes more computing time than the time limit leaves"
                              : hn_status_text(status));
    }
    hn_precise_model_free(p.model);
    hn_arena_free(arena);
    return status;
}
