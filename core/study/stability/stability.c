// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability/stability.h"

#include "study/spectrum/region.h"

#include "base/clock.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const class_names[] = {
#define HN_STABILITY_NAME(code, name) name,
    HN_STABILITY_CLASS_LIST(HN_STABILITY_NAME)
#undef HN_STABILITY_NAME
};

// tight enough that what a trial is measured by is not the path's own error
static const char *const MEANS[] = {"projection@dop853:rtol=1e-9", "projection@radau5:rtol=1e-7"};
enum { N_MEANS = sizeof MEANS / sizeof *MEANS };
static const double FIRST_SHARE = 1. / 3; // of the computing time of a path: its first means

struct hn_stability_path {
    const hn_system *sys;
    hn_system_info info;
    hn_arena *arena;
    hn_eval *mass;
    const double *q0, *v0;
    double T, length;
    double *v;                              ///< (looks + 1) x nv: speeds, system coordinates
    double *M;                              ///< (looks + 1) x nv x nv
    double *energy;                         ///< looks + 1
    double highest, highest_kinetic, scale; ///< [J]
    double rate;                            ///< see hn_stability_path_rate()
    int n_values[HN_STABILITY_LOOKS + 1];
    hn_eigenvalue *values; ///< (looks + 1) x 2 nv
    double *q;             ///< nq: scratch while it is made
};

const char *hn_stability_class_name(hn_stability_class kind) {
    return kind < HN_STABILITY_CLASS_COUNT ? class_names[kind] : "?";
}

bool hn_stability_is_stable(hn_stability_class kind) {
    return kind == HN_STABILITY_FINE || kind == HN_STABILITY_INACCURATE;
}

// ---- the path ----

typedef struct making {
    hn_stability_path *path;
    hn_spectrum *spectrum;
    double v_min, v_max; ///< range of the potential [J]
} making;

static int see_path(void *user, int k, const hn_sample *s) {
    making *m = user;
    hn_stability_path *p = m->path;
    const size_t nv = (size_t)p->info.nv;
    double *v = p->v + (size_t)k * nv;
    const hn_eigenvalue *values;

    // velocities and mass matrix
    hn_system_from_user(p->sys, s->q, p->q);
    hn_system_rates_from_user(p->sys, s->v, v);
    hn_eval_run(p->mass, s->t, p->q, v);
    memcpy(p->M + (size_t)k * nv * nv, hn_eval_get(p->mass, HN_TERM_M), nv * nv * sizeof(double));

    // the largest rate of a coordinate
    const hn_scene *scene = hn_system_scene(p->sys);
    for (int i = 0; i < p->info.n_user; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(p->sys, i)];
        p->rate = fmax(p->rate, fabs(s->v[i]) / (c->kind == HN_LENGTH ? p->length : 1));
    }

    // energies and their ranges
    p->energy[k] = s->energy;
    p->highest = fmax(p->highest, s->energy);
    p->highest_kinetic = fmax(p->highest_kinetic, s->kinetic);
    m->v_min = fmin(m->v_min, s->potential);
    m->v_max = fmax(m->v_max, s->potential);

    // the spectrum; where it does not exist, the prediction rests on the other states
    if (hn_spectrum_calc(m->spectrum, s->t, p->q, v, &values, &p->n_values[k]) != HN_OK) {
        p->n_values[k] = 0;
    }
    memcpy(p->values + (size_t)k * 2 * nv, values, (size_t)p->n_values[k] * sizeof *values);
    return 1;
}

static hn_status compute_by(making *m, const char *means, const hn_walk_limits *limits,
                            hn_diag *diag) {
    hn_stability_path *p = m->path;
    hn_method_spec spec;
    hn_run *run = NULL;
    hn_sample start;

    // the run by this method
    hn_status status = hn_method_parse(means, &spec, diag);
    HN_THEN(status, hn_run_create(p->sys, &spec, p->q0, p->v0, NULL, &run, diag));
    HN_THEN(status, hn_run_sample(run, 0, &start));
    if (status != HN_OK) {
        hn_run_free(run);
        return status;
    }

    // start anew: an earlier method may have failed on the way
    p->highest_kinetic = p->rate = 0;
    p->highest = -HUGE_VAL;
    m->v_min = HUGE_VAL;
    m->v_max = -HUGE_VAL;

    // walk along the path
    hn_run_watch(run, 0);
    see_path(m, 0, &start);
    const hn_walk_end end = hn_walk(run, p->T, HN_STABILITY_LOOKS, limits, see_path, m);
    const hn_run_summary s = hn_run_get_summary(run);

    // why it ended early
    if (end == HN_WALK_FAILED) {
        status = hn_diag_set(diag, s.status, NULL, NULL, "%s ended at t = %.4g s: %s", means, s.t,
                             s.reason);
    } else if (end != HN_WALK_DONE) {
        status = hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "%s at t = %.4g s",
                             end == HN_WALK_OVER ? "the computing time for the path was used up"
                                                 : "stopped on request",
                             s.t);
    }

    hn_run_free(run);
    return status;
}

/// [s] A means that had less was not tried. Another one in its place would make the numbers depend
/// on the time limit; a run that goes on tries the same again.
static const double LEAST_TRIAL = 0.1;

static hn_status compute(making *m, const hn_walk_limits *limits, hn_diag *diag) {
    hn_stability_path *p = m->path;
    hn_status status = HN_ERR_INTERNAL;
    for (int k = 0; k < N_MEANS; k++) {
        hn_walk_limits own = *limits;
        own.seconds *= k < N_MEANS - 1 ? FIRST_SHARE : 1;
        status = compute_by(m, MEANS[k], &own, diag);
        const bool untried =
            status == HN_ERR_STOPPED && own.seconds > 0 && own.seconds < LEAST_TRIAL;
        if (status == HN_OK || untried || (limits->stop && limits->stop(limits->user))) {
            break;
        }
    }
    if (status != HN_OK) {
        return status;
    }
    p->scale = p->highest_kinetic + (m->v_max - m->v_min);
    if (!(p->scale > 0)) {
        return hn_diag_set(
            diag, HN_ERR_INPUT, NULL,
            "give the start a velocity, or a configuration that is not at rest",
            "the mechanism does not move, so the growth of an error cannot be measured");
    }
    return HN_OK;
}

static hn_status make_memory(hn_stability_path *p) {
    const size_t nv = (size_t)p->info.nv, rows = HN_STABILITY_LOOKS + 1;
    p->v = hn_arena_doubles(p->arena, rows * nv);
    p->M = hn_arena_doubles(p->arena, rows * nv * nv);
    p->energy = hn_arena_doubles(p->arena, rows);
    p->values = hn_arena_get(p->arena, (rows * 2 * nv + 1) * sizeof *p->values);
    p->q = hn_arena_doubles(p->arena, (size_t)p->info.nq);
    return hn_arena_failed(p->arena) ? HN_ERR_MEMORY
                                     : hn_eval_create(p->sys, HN_TERM_M, p->arena, &p->mass);
}

hn_status hn_stability_path_create(const hn_system *sys, const double *q, const double *v, double T,
                                   const hn_walk_limits *limits, hn_stability_path **out,
                                   hn_diag *diag) {
    hn_arena *arena = hn_arena_create(0);
    hn_stability_path *p = arena ? hn_arena_get(arena, sizeof *p) : NULL;
    making m = {.path = p};
    *out = NULL;
    if (!p) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *p = (hn_stability_path){.sys = sys,
                             .info = hn_system_get_info(sys),
                             .arena = arena,
                             .q0 = q,
                             .v0 = v,
                             .T = T,
                             .length = hn_system_length(sys)};
    hn_status status = make_memory(p);
    HN_THEN(status, hn_spectrum_create(sys, arena, &m.spectrum));
    if (status != HN_OK) {
        hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
    } else {
        status = compute(&m, limits, diag);
    }
    hn_spectrum_free(m.spectrum);
    status = hn_system_stopped(sys, status, diag);
    if (status != HN_OK) {
        hn_stability_path_free(p);
        return status;
    }
    *out = p;
    return HN_OK;
}

void hn_stability_path_free(hn_stability_path *p) {
    if (p) {
        hn_eval_free(p->mass);
        hn_arena_free(p->arena);
    }
}

double hn_stability_path_rate(const hn_stability_path *p) {
    return p->rate;
}

/// Returns the number of eigenvalues at state k of the path (0 .. HN_STABILITY_LOOKS), and them,
/// fastest first; 0 where there is no spectrum (a singular configuration).
static int path_eigenvalues(const hn_stability_path *p, int k, const hn_eigenvalue **out) {
    *out = p->values + (size_t)k * 2 * (size_t)p->info.nv;
    return p->n_values[k];
}

// ---- the prediction ----

// why the spectrum on the loops does not apply to this method; NULL when it does
static const char *why_not(const hn_method_spec *spec) {
    const unsigned traits = spec->formulation->traits;
    if (hn_method_form(spec->formulation, spec->stepper) != HN_FORM_ODE) {
        return "the integrator takes the differential-algebraic system: its limit is where "
               "Newton's "
               "method ends, not an instability";
    }
    if (traits & HN_TRAIT_ADDS_VIBRATIONS) {
        return "the penalty adds vibrations that the mechanism does not have";
    }
    if ((traits & HN_TRAIT_PULLS_GAP) && hn_method_option(spec, "rule", 0) != 0) {
        return "alpha and beta follow the motion";
    }
    return hn_stability_why_not(spec->stepper);
}

/// The roots of the feedback on the gap, where the formulation has one; returns their number.
static int feedback_roots(const hn_method_spec *spec, hn_eigenvalue out[2]) {
    if (!(spec->formulation->traits & HN_TRAIT_PULLS_GAP)) {
        return 0;
    }
    hn_stability_baumgarte(hn_method_option(spec, "alpha", 0), hn_method_option(spec, "beta", 0),
                           out);
    return 2;
}

// growth over so many steps of the fastest growing eigenvalue, at the state with the smallest limit
static double growth_over(const hn_stepper *stepper, const hn_eigenvalue *s, int n, double h,
                          double steps) {
    double most = 0;
    for (int i = 0; i < n; i++) {
        const double re = fmin(s[i].re, 0);
        if (s[i].im >= 0 && (s[i].re <= 0 || s[i].im > 0)) {
            most = fmax(most, steps * log(hn_stability_growth(stepper, h * re, h * s[i].im)));
        }
    }
    return most;
}

static double find_visible(const hn_stepper *stepper, const hn_eigenvalue *s, int n, double limit,
                           long long steps) {
    const double wanted = log(HN_STABILITY_SLOW), ratio = 1.02;
    double h = limit;
    for (int k = 0; k < 120; k++, h *= ratio) {
        if (growth_over(stepper, s, n, h, (double)steps) >= wanted) {
            return h;
        }
    }
    return h;
}

hn_stability_forecast hn_stability_predict(const hn_stability_path *p, const hn_method_spec *spec,
                                           long long steps) {
    hn_stability_forecast f = {.limit = HUGE_VAL, .start = HUGE_VAL, .visible = HUGE_VAL};
    f.why = why_not(spec);
    if (f.why) {
        f.limit = f.start = f.visible = (double)NAN;
        return f;
    }

    // limit of the stabilised gap equation; with a root in the right half-plane the gap grows at
    // any step
    hn_eigenvalue roots[2];
    const int n_roots = feedback_roots(spec, roots);
    const double gap = n_roots == 0 ? HUGE_VAL
                       : roots[0].re > 0 || roots[1].re > 0
                           ? 0
                           : hn_stability_limit(spec->stepper, roots, 2);

    // limit along the path: the smallest, and the one at the start
    for (int k = 0; k <= HN_STABILITY_LOOKS; k++) {
        const hn_eigenvalue *s;
        const int n = path_eigenvalues(p, k, &s);
        const double limit = fmin(gap, hn_stability_limit(spec->stepper, s, n));
        f.start = k == 0 ? limit : f.start;
        if (limit < f.limit) {
            f.limit = limit;
            f.look = k;
        }
    }

    // the step from which growth shows within the run
    if (f.limit > 0 && isfinite(f.limit)) {
        const hn_eigenvalue *s;
        const int n = path_eigenvalues(p, f.look, &s);
        f.visible = gap <= f.limit ? find_visible(spec->stepper, roots, 2, f.limit, steps)
                                   : find_visible(spec->stepper, s, n, f.limit, steps);
    }
    return f;
}

// ---- the trial ----

typedef struct trial {
    const hn_stability_path *path;
    hn_stability_trial *out;
    double *v, *difference;
    int looks;          ///< of this trial: those past HN_STABILITY_LOOKS are past the path's end
    double work;        ///< of drives, dampers and loads up to the path's end [J]
    double early, late; ///< highest energy above the path's in the first and the last third
} trial;

static void tell_growth(hn_stability_trial *o, double energy) {
    o->kind = HN_STABILITY_GREW;
    if (!isfinite(energy)) {
        snprintf(o->reason, sizeof o->reason, "the energy stopped being finite, at t = %.4g s",
                 o->t_reached);
        return;
    }
    snprintf(
        o->reason, sizeof o->reason,
        "the energy grew beyond that of the true motion by %.3g times its range, at t = %.4g s",
        energy, o->t_reached);
}

// 1 when there is no need to go on. An energy that swings widely is no growth yet: symplectic
// integrators do that close to their limit.
static bool ran_away(trial *t, double energy, double gap) {
    hn_stability_trial *o = t->out;
    o->energy = fmax(o->energy, energy);
    o->gap = fmax(o->gap, gap);
    if (!(energy <= HN_STABILITY_RUNAWAY)) {
        tell_growth(o, energy);
        return true;
    }
    if (!(gap <= HN_STABILITY_OPEN)) {
        o->kind = HN_STABILITY_GREW;
        snprintf(o->reason, sizeof o->reason,
                 "the loop stands open by %.3g of the mechanism's length, at t = %.4g s", gap,
                 o->t_reached);
        return true;
    }
    return false;
}

static void note_third(trial *t, int k, double energy) {
    if (3 * k <= t->looks) {
        t->early = fmax(t->early, energy);
    } else if (3 * k > 2 * t->looks) {
        t->late = fmax(t->late, energy);
    }
}

static void compare_speeds(trial *t, int k, const hn_sample *s) {
    const hn_stability_path *p = t->path;
    const size_t nv = (size_t)p->info.nv;
    hn_system_rates_from_user(p->sys, s->v, t->v);
    for (size_t i = 0; i < nv; i++) {
        t->difference[i] = t->v[i] - p->v[(size_t)k * nv + i];
    }
    const double *M = p->M + (size_t)k * nv * nv;
    const double size = hn_quad_sym(p->info.nv, M, t->difference, t->difference) / 2;
    t->out->error = fmax(t->out->error, sqrt(fmax(0, size) / p->scale));
}

// 1 when there is no need to go on
static bool look(trial *t, hn_run *run, int k, double time) {
    const hn_stability_path *p = t->path;
    const int beyond = k > HN_STABILITY_LOOKS;
    hn_sample s;
    // a fixed step ends before the look, and the shorter one to it may fail where the step itself
    // does not
    const int there = hn_run_sample(run, time, &s) == HN_OK;
    if (!there && hn_run_sample(run, hn_run_time(run), &s) != HN_OK) {
        return false;
    }

    // beyond the path's end the energy that loads put in is no growth
    if (!beyond) {
        t->work = s.work;
    }
    const double put_in = beyond ? fmax(0, s.work - t->work) : 0; // 0 where it is not known
    const double energy = (s.energy - put_in - (beyond ? p->highest : p->energy[k])) / p->scale;
    t->out->t_reached = s.t;
    note_third(t, k, energy);
    if (ran_away(t, energy, s.gap / p->length)) {
        return true;
    }
    if (!beyond && there) {
        compare_speeds(t, k, &s);
    }
    return false;
}

static void conclude(trial *t, hn_walk_end end, const hn_run *run, const hn_walk_limits *limits) {
    const hn_run_summary s = hn_run_get_summary(run);
    hn_stability_trial *o = t->out;
    o->steps = s.steps;
    o->t_reached = s.t;

    if (o->kind == HN_STABILITY_GREW) {
        return;
    }

    // why the walk ended; one that reached the end is judged by its errors
    switch (end) {
    case HN_WALK_FAILED:
        o->kind = s.status == HN_ERR_DIVERGED ? HN_STABILITY_GREW : HN_STABILITY_STOPPED;
        o->status = s.status;
        snprintf(o->reason, sizeof o->reason, "%.255s", s.reason);
        break;
    case HN_WALK_OVER:
        o->kind = HN_STABILITY_SKIPPED;
        snprintf(o->reason, sizeof o->reason,
                 "left at t = %.4g s: more than %g s of computing time", s.t, limits->seconds);
        break;
    case HN_WALK_STOPPED:
        *o = (hn_stability_trial){.kind = HN_STABILITY_PENDING};
        break;
    case HN_WALK_DONE:
        if (t->late > HN_STABILITY_GROWN && t->late > HN_STABILITY_RISING * t->early) {
            tell_growth(o, t->late);
            break;
        }
        o->kind = o->error <= HN_STABILITY_ACCURATE ? HN_STABILITY_FINE : HN_STABILITY_INACCURATE;
        break;
    }
}

// to the end of the path, and beyond it until there are enough steps for growth to show
static hn_walk_end walk(trial *t, hn_run *run, double h, const hn_walk_limits *limits) {
    const double T = t->path->T, least = HN_STABILITY_LEAST_STEPS * h, more = fmax(0, least - T);
    const int looks = more > 0 ? 2 * HN_STABILITY_LOOKS : HN_STABILITY_LOOKS;
    t->looks = looks;
    hn_walk_limits left = *limits;

    for (int k = 1; k <= looks; k++) {
        const int beyond = k > HN_STABILITY_LOOKS;
        const double time = beyond ? T + more * (k - HN_STABILITY_LOOKS) / HN_STABILITY_LOOKS
                                   : T * k / HN_STABILITY_LOOKS;

        // advance to the check time, and compare there
        const double before = hn_clock_thread();
        const hn_walk_end end = hn_walk(run, time, 1, &left, NULL, NULL);
        if (end != HN_WALK_DONE || look(t, run, k, time)) {
            return end;
        }

        // computing time left, and requests to stop
        if (limits->seconds > 0) {
            left.seconds -= hn_clock_thread() - before;
            if (left.seconds <= 0) {
                return HN_WALK_OVER;
            }
        }
        if (limits->stop && limits->stop(limits->user)) {
            return HN_WALK_STOPPED;
        }
    }
    return HN_WALK_DONE;
}

int hn_stability_try(const hn_stability_path *p, const hn_method_spec *spec,
                     const hn_walk_limits *limits, hn_stability_trial *out) {
    const double h = hn_method_is_adaptive(spec) ? 0 : hn_method_option(spec, "h", 0);
    const double wanted = h > 0 ? p->T / h : 0;
    hn_arena *arena = hn_arena_create(0);
    hn_run *run = NULL;
    hn_diag diag = {0};
    trial t = {.path = p, .out = out};

    // memory and the run; a refused method keeps its reason
    *out = (hn_stability_trial){.kind = HN_STABILITY_REFUSED};
    if (arena) {
        t.v = hn_arena_doubles(arena, (size_t)p->info.nv);
        t.difference = hn_arena_doubles(arena, (size_t)p->info.nv);
    }
    out->status = arena && !hn_arena_failed(arena)
                      ? hn_run_create(p->sys, spec, p->q0, p->v0, NULL, &run, &diag)
                      : HN_ERR_MEMORY;
    if (out->status != HN_OK) {
        const bool stopped = out->status == HN_ERR_STOPPED;
        out->kind = stopped ? HN_STABILITY_PENDING : HN_STABILITY_REFUSED;
        snprintf(out->reason, sizeof out->reason, "%.250s",
                 diag.message[0] ? diag.message : hn_status_text(out->status));
        hn_arena_free(arena);
        return !stopped;
    }

    // often enough to detect a growing gap or energy, seldom enough to cost little
    hn_run_watch(run, (int)fmax(1, fmin(1000, wanted / 200)));
    conclude(&t, walk(&t, run, h, limits), run, limits);

    hn_run_free(run);
    hn_arena_free(arena);
    return out->kind != HN_STABILITY_PENDING;
}
