// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "study/run/run_internal.h"

#include <math.h>
#include <string.h>

#define SAME_TIME 1e-9     // of a step
#define ROUNDED_TIME 2e-14 // relative

// a state of `side` at time t from its y: mended as after a step, then read
static hn_status finish_side(hn_run *run, double t, double *y) {
    hn_run_engine *e = &run->side;
    int changed = 0;
    const hn_status status = hn_engine_mend(run, e, t, y, &changed);
    return status == HN_OK ? hn_engine_read(run, e, t, y, run->at_q, run->at_v) : status;
}

// steps of an integrator that chooses their size, up to t
static hn_status side_steps_to(hn_run *run, double from, double t) {
    hn_run_engine *e = &run->side;
    hn_status status = HN_OK;
    while (status == HN_OK && from < t) {
        int changed = 0;
        status = hn_engine_advance(run, e, from, t, &from);
        if (status == HN_OK && from < t) {
            status = hn_engine_mend(run, e, from, e->y_new, &changed);
            hn_engine_accepted(run, e, changed);
            memcpy(e->y, e->y_new, (size_t)(e->ode.n_pos + e->ode.n_vel) * sizeof *e->y);
        }
    }
    return status;
}

// a step of the same integrator from a known state, made by the engine that is not the run's own
static hn_status side_step(hn_run *run, const hn_run_state_at *from, double t) {
    hn_run_engine *e = &run->side;
    hn_status status = hn_engine_start(run, e, from->t, from->q, from->v);
    if (status != HN_OK) {
        return status;
    }
    status = hn_engine_paces_itself(run) ? side_steps_to(run, from->t, t)
                                         : hn_engine_step(run, e, from->t, t - from->t);
    if (status == HN_OK && run->opts.raw_lambda) {
        hn_engine_accepted(run, e, 0);
        run->at_raw = hn_engine_raw_lambda(run, e);
    }
    return status == HN_OK ? finish_side(run, t, e->y_new) : status;
}

// the same from the present state, stopping at corners of loads on the way as the run will
static hn_status side_steps_ahead(hn_run *run, double t) {
    hn_run_state_at from = run->now;
    double corner = run->corner;
    while (corner < t) {
        const double end = from.t + hn_run_step_short_of(from.t, corner);
        const hn_status status = side_step(run, &from, end);
        if (status != HN_OK) {
            return status;
        }
        from = (hn_run_state_at){corner, run->at_q, run->at_v};
        corner = hn_system_next_corner(run->sys, corner);
    }
    return side_step(run, &from, t);
}

// dense output of the last step, then closed like any other state
static hn_status interpolate(hn_run *run, double t) {
    hn_run_engine *e = &run->main;
    hn_engine_dense(run, e, (t - run->before.t) / (run->now.t - run->before.t), run->side.y_new);
    if (!run->spec.formulation->after_step) {
        int changed = 0;
        const hn_status mended = hn_engine_mend(run, e, t, run->side.y_new, &changed);
        return mended == HN_OK ? hn_engine_read(run, e, t, run->side.y_new, run->at_q, run->at_v)
                               : mended;
    }
    hn_status status = hn_engine_read(run, e, t, run->side.y_new, run->at_q, run->at_v);
    if (status == HN_OK) {
        status = hn_engine_start(run, &run->side, t, run->at_q, run->at_v);
    }
    return status == HN_OK ? finish_side(run, t, run->side.y) : status;
}

static hn_status locate(hn_run *run, double t) {
    const double h = run->h_next;
    const double tol = SAME_TIME * (run->h > 0 ? run->h : fabs(h));
    // steps that are chosen may end a rounding short of a time that somebody divided out
    const double ahead = t - run->now.t;
    const int here =
        run->adaptive ? ahead >= 0 && ahead <= ROUNDED_TIME * fabs(t) : fabs(ahead) <= tol;
    if (here) {
        memcpy(run->at_q, run->now.q, (size_t)run->info.nq * sizeof(double));
        memcpy(run->at_v, run->now.v, (size_t)run->info.nv * sizeof(double));
        run->at_raw = run->has_step ? hn_engine_raw_lambda(run, &run->main) : NULL;
        return HN_OK;
    }
    if (t < run->now.t) {
        if (!run->has_step || t < run->before.t) {
            return HN_ERR_INPUT;
        }
        const int dense =
            run->dense_valid && !(run->opts.raw_lambda && hn_engine_has_raw_lambda(run));
        return dense ? interpolate(run, t) : side_step(run, &run->before, t);
    }
    const int ahead_allowed =
        !run->adaptive && t < run->now.t + h && run->summary.state != HN_RUN_FAILED;
    return ahead_allowed ? side_steps_ahead(run, t) : HN_ERR_INPUT;
}

static void fill_forces(hn_run *run, double t, hn_sample *out) {
    run->at_t = t;
    run->at_info = (hn_accel_info){0};
    run->at_status = hn_run_accelerations(run, t, run->at_q, run->at_v, run->at_a,
                                          run->sample_lambda, &run->at_info);
    if (run->at_status == HN_OK) {
        hn_system_rates_to_user(run->sys, run->at_a, run->sample_a);
    } else {
        for (int i = 0; i < run->info.n_user; i++) {
            run->sample_a[i] = nan("");
        }
        for (int i = 0; i < run->info.nc; i++) {
            run->sample_lambda[i] = nan("");
        }
    }
    out->pivot_ratio = run->at_info.pivot_ratio;
    out->rank = run->at_info.rank;
}

hn_multiplier_mark hn_run_sample_mark(hn_run *run) {
    return run->at_status == HN_OK
               ? hn_accel_mark(run->watch.accel, run->at_t, run->at_q, run->at_v, &run->at_info)
               : HN_MULTIPLIERS_NONE;
}

int hn_run_has_raw_lambda(const hn_run *run) {
    return hn_engine_has_raw_lambda(run);
}

hn_status hn_run_sample(hn_run *run, double t, hn_sample *out) {
    if (!isfinite(t)) {
        return HN_ERR_INPUT;
    }
    run->at_raw = NULL;
    const hn_status status = locate(run, t);
    if (status != HN_OK) {
        return status;
    }
    *out = (hn_sample){.t = t,
                       .q = run->sample_q,
                       .v = run->sample_v,
                       .a = run->sample_a,
                       .lambda = run->sample_lambda,
                       .points = run->sample_points};
    hn_system_to_user(run->sys, run->at_q, run->sample_q);
    hn_system_rates_to_user(run->sys, run->at_v, run->sample_v);
    if (run->opts.raw_lambda && run->at_raw) {
        memcpy(run->sample_raw, run->at_raw, (size_t)run->info.nc * sizeof(double));
        out->raw_lambda = run->sample_raw;
    }
    fill_forces(run, t, out);
    hn_run_measure(run, t, run->at_q, run->at_v, &out->gap, &out->velocity_gap, &out->kinetic,
                   &out->potential);
    const double row = hn_run_shortest_row(run); // as the watch sees it: J M^-1 J' has it squared
    out->pivot_ratio *= row * row;
    out->energy = out->kinetic + out->potential;
    out->energy_change = out->energy - run->watch.start_energy;
    hn_eval_run(run->points, t, run->at_q, run->at_v);
    memcpy(run->sample_points, hn_eval_get(run->points, HN_TERM_POINTS),
           3 * (size_t)run->info.n_points * sizeof(double));
    return HN_OK;
}

const char *hn_run_sample_why(const hn_run *run, hn_status status) {
    const char *why = status != HN_ERR_DIVERGED ? hn_engine_why(run, &run->side) : NULL;
    return why ? why : hn_status_text(status);
}
