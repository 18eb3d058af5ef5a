// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/sampling.h"

#include "dynamics/compile/coordinates.h"
#include "study/incidents/inside.h"
#include "study/incidents/motion.h"

#include <math.h>
#include <string.h>

#define SAME_TIME 1e-9     // of a step
#define ROUNDED_TIME 2e-14 // relative

// ---- states between steps ----

/// A state of the side engine at time t from its y: corrected as after a step, then read.
static hn_status finish_side(hn_sampling *s, double t, double *y) {
    int changed = 0;
    HN_TRY(hn_engine_correct(&s->side, t, y, &changed));
    return hn_engine_read(&s->side, t, y, s->q, s->v);
}

/// Steps of an integrator that chooses their size, up to t.
static hn_status side_steps_to(hn_sampling *s, double from, double t) {
    hn_engine *e = &s->side;
    while (from < t) {
        int changed = 0;
        HN_TRY(hn_engine_advance(e, from, t, &from));
        if (from < t) {
            HN_TRY(hn_engine_correct(e, from, e->y_new, &changed));
            hn_engine_accepted(e, changed);
            memcpy(e->y, e->y_new, (size_t)(e->ode.n_pos + e->ode.n_vel) * sizeof *e->y);
        }
    }
    return HN_OK;
}

/// A step of the same integrator from a known state, made by the side engine.
static hn_status side_step(hn_sampling *s, const hn_state_at *from, double t) {
    hn_engine *e = &s->side;
    HN_TRY(hn_engine_start(e, from->t, from->q, from->v));
    HN_TRY(hn_engine_paces_itself(&s->run->spec) ? side_steps_to(s, from->t, t)
                                                 : hn_engine_step(e, from->t, t - from->t));
    if (s->raw_lambda) {
        hn_engine_accepted(e, 0);
        s->raw = hn_engine_raw_lambda(e);
    }
    return finish_side(s, t, e->y_new);
}

/// The same from the present state; stops at corners of loads on the way, as the run does.
static hn_status side_steps_ahead(hn_sampling *s, double t) {
    hn_state_at from = s->run->now;
    double corner = s->run->corner;
    while (corner < t) {
        HN_TRY(side_step(s, &from, from.t + hn_stepping_short_of(from.t, corner)));
        from = (hn_state_at){corner, s->q, s->v};
        corner = hn_system_next_corner(s->run->sys, corner);
    }
    return side_step(s, &from, t);
}

/// Dense output of the last step, then closed like any other state.
static hn_status interpolate(hn_sampling *s, double t) {
    hn_stepping *run = s->run;
    double *y = s->side.y_new;
    hn_engine_dense(&run->engine, (t - run->before.t) / (run->now.t - run->before.t), y);
    if (!run->spec.formulation->after_step) {
        int changed = 0;
        HN_TRY(hn_engine_correct(&run->engine, t, y, &changed));
        return hn_engine_read(&run->engine, t, y, s->q, s->v);
    }
    HN_TRY(hn_engine_read(&run->engine, t, y, s->q, s->v));
    HN_TRY(hn_engine_start(&s->side, t, s->q, s->v));
    return finish_side(s, t, s->side.y);
}

static void take_present(hn_sampling *s) {
    const hn_stepping *run = s->run;
    memcpy(s->q, run->now.q, (size_t)run->info.nq * sizeof(double));
    memcpy(s->v, run->now.v, (size_t)run->info.nv * sizeof(double));
    s->raw = run->has_step ? hn_engine_raw_lambda(&run->engine) : NULL;
}

static bool is_present(const hn_stepping *run, double t) {
    const double tol = SAME_TIME * (run->h > 0 ? run->h : fabs(run->h_next));
    // adaptive steps may end short of the requested time by rounding
    const double ahead = t - run->now.t;
    return run->adaptive ? ahead >= 0 && ahead <= ROUNDED_TIME * fabs(t) : fabs(ahead) <= tol;
}

/// A state between steps must be as sane as one at the end of a step.
static hn_status sane(const hn_sampling *s, hn_status status) {
    const hn_stepping *run = s->run;
    const bool is = status != HN_OK || (hn_stepping_is_sane(run->info.nq, s->q) &&
                                        hn_stepping_is_sane(run->info.nv, s->v));
    return is ? status : HN_ERR_DIVERGED;
}

static hn_status locate(hn_sampling *s, double t, bool failed) {
    const hn_stepping *run = s->run;
    if (is_present(run, t)) {
        take_present(s);
        return HN_OK;
    }
    if (t >= run->now.t) {
        const bool allowed = !run->adaptive && t < run->now.t + run->h_next && !failed;
        return allowed ? sane(s, side_steps_ahead(s, t)) : HN_ERR_INPUT;
    }
    if (!run->has_step || t < run->before.t) {
        return HN_ERR_INPUT;
    }
    // the scheme's own multipliers belong to the end of a step
    const bool dense =
        run->dense_valid && !(s->raw_lambda && hn_engine_has_raw_lambda(&run->engine));
    return sane(s, dense ? interpolate(s, t) : side_step(s, &run->before, t));
}

// ---- what a sample holds ----

static void fill_forces(hn_sampling *s, double t, hn_sample *out) {
    const hn_stepping *run = s->run;
    s->t = t;
    s->info = (hn_accel_info){0};
    s->status = hn_accel_eval(run->accel, t, s->q, s->v, 0, 0, s->a, s->lambda, &s->info);
    if (s->status == HN_OK) {
        hn_system_rates_to_user(run->sys, s->a, s->user_a);
    } else {
        for (int i = 0; i < run->info.n_user; i++) {
            s->user_a[i] = nan("");
        }
        for (int i = 0; i < run->info.nc; i++) {
            s->lambda[i] = nan("");
        }
    }
    out->pivot_ratio = s->info.pivot_ratio;
    out->rank = s->info.rank;
}

static void fill_measures(hn_sampling *s, double t, hn_sample *out) {
    const hn_measure m = hn_watch_measure(s->watch, t, s->q, s->v);
    hn_eval_run(s->rows_eval, t, s->q, s->v);
    const double row = hn_motion_shortest_row(s->watch, &s->rows); // J M^-1 J' has it squared
    out->gap = s->gap = m.gap;
    out->velocity_gap = m.velocity_gap;
    out->kinetic = m.kinetic;
    out->potential = m.potential;
    out->energy = m.kinetic + m.potential;
    const hn_state_at at = {t, s->q, s->v};
    out->energy_change = hn_watch_energy_change(s->watch, &at, &m, &out->work);
    out->pivot_ratio *= row * row;
    if (s->watch->every > 0 && !is_present(s->run, t)) {
        s->inside++;
        hn_inside_check(s->watch, &at, &m, out->energy_change);
    }
}

hn_status hn_sampling_at(hn_sampling *s, double t, bool failed, hn_sample *out) {
    const hn_stepping *run = s->run;
    s->raw = NULL;
    HN_TRY(locate(s, t, failed));

    // the state in user coordinates
    *out = (hn_sample){.t = t,
                       .q = s->user_q,
                       .v = s->user_v,
                       .a = s->user_a,
                       .lambda = s->lambda,
                       .points = s->points};
    hn_system_to_user(run->sys, s->q, s->user_q);
    hn_system_rates_to_user(run->sys, s->v, s->user_v);

    // multipliers of the method itself
    if (s->raw_lambda && s->raw) {
        memcpy(s->raw_copy, s->raw, (size_t)run->info.nc * sizeof(double));
        out->raw_lambda = s->raw_copy;
    }

    // quantities that are evaluated from the state
    fill_forces(s, t, out);
    fill_measures(s, t, out);
    hn_eval_run(s->points_eval, t, s->q, s->v);
    memcpy(s->points, hn_eval_get(s->points_eval, HN_TERM_POINTS),
           3 * (size_t)run->info.n_points * sizeof(double));
    return HN_OK;
}

// ---- life ----

hn_status hn_sampling_create(hn_stepping *run, hn_watch *watch, bool raw_lambda, hn_sampling *s,
                             hn_diag *diag) {
    hn_arena *arena = run->arena;
    const size_t nq = (size_t)run->info.nq, nv = (size_t)run->info.nv, nc = (size_t)run->info.nc;
    *s = (hn_sampling){.run = run, .watch = watch, .raw_lambda = raw_lambda};

    // user coordinates are never more than those of the system
    double **const positions[] = {&s->q, &s->user_q};
    double **const velocities[] = {&s->v, &s->a, &s->user_v, &s->user_a};
    double **const rows[] = {&s->lambda, &s->raw_copy};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) {
        *positions[i] = hn_arena_doubles(arena, nq);
    }
    for (size_t i = 0; i < sizeof velocities / sizeof *velocities; i++) {
        *velocities[i] = hn_arena_doubles(arena, nv);
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        *rows[i] = hn_arena_doubles(arena, nc);
    }

    // evaluators of points and rows, and a second engine beside the run
    s->points = hn_arena_doubles(arena, 3 * (size_t)run->info.n_points);
    if (hn_arena_failed(arena) ||
        hn_eval_create(run->sys, HN_TERM_POINTS, arena, &s->points_eval) != HN_OK ||
        hn_eval_create_listed(run->sys, HN_CLOSURE_ROWS_TERMS, arena, &s->rows_eval) != HN_OK ||
        hn_closure_rows_create(s->rows_eval, run->info.nc, arena, &s->rows) != HN_OK) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    return hn_engine_create(run->sys, &run->spec, run->accel, arena, &s->side, diag);
}

void hn_sampling_free(hn_sampling *s) {
    hn_engine_destroy(&s->side);
    hn_eval_free(s->points_eval);
    hn_eval_free(s->rows_eval);
}
