#include "study/run_internal.h"

#include <math.h>
#include <string.h>

#define SAME_TIME 1e-9 // of a step

// a state of `side` at time t from its y: mended as after a step, then read
static hn_status finish_side(hn_run *run, double t, double *y) {
    const hn_formulation *f = run->spec.formulation;
    hn_run_engine *e = &run->side;
    int changed = 0;
    hn_status status = f->after_step ? f->after_step(e->formulation, t, y, &changed) : HN_OK;
    if (status == HN_OK) {
        status = f->get_state(e->formulation, t, y, run->at_q, run->at_v);
    }
    return status;
}

// a step of the same integrator from a known state, made by the engine that is not the run's own
static hn_status side_step(hn_run *run, const hn_run_state_at *from, double t) {
    hn_run_engine *e = &run->side;
    const hn_formulation *f = run->spec.formulation;
    hn_status status = f->set_state(e->formulation, from->t, from->q, from->v, e->y);
    if (status != HN_OK) {
        return status;
    }
    run->spec.stepper->accepted(e->stepper, 1);
    f->ode(e->formulation, &e->ode);
    status =
        run->spec.stepper->step(e->stepper, &e->ode, from->t, t - from->t, e->y, e->y_new, e->err);
    return status == HN_OK ? finish_side(run, t, e->y_new) : status;
}

// dense output of the last step, then closed like any other state
static hn_status interpolate(hn_run *run, double t) {
    hn_run_engine *e = &run->main;
    const hn_formulation *f = run->spec.formulation;
    run->spec.stepper->dense(e->stepper, (t - run->before.t) / (run->now.t - run->before.t),
                             run->side.y_new);
    hn_status status = f->get_state(e->formulation, t, run->side.y_new, run->at_q, run->at_v);
    if (status != HN_OK || !f->after_step) {
        return status;
    }
    status = f->set_state(run->side.formulation, t, run->at_q, run->at_v, run->side.y);
    return status == HN_OK ? finish_side(run, t, run->side.y) : status;
}

static hn_status locate(hn_run *run, double t) {
    const double h = run->h_next;
    const double tol = SAME_TIME * (run->h > 0 ? run->h : fabs(h));
    if (fabs(t - run->now.t) <= (run->spec.stepper->adaptive ? 0 : tol)) {
        memcpy(run->at_q, run->now.q, (size_t)run->info.nq * sizeof(double));
        memcpy(run->at_v, run->now.v, (size_t)run->info.nv * sizeof(double));
        return HN_OK;
    }
    if (t < run->now.t) {
        if (!run->has_step || t < run->before.t) {
            return HN_ERR_INPUT;
        }
        return run->dense_valid ? interpolate(run, t) : side_step(run, &run->before, t);
    }
    const int ahead_allowed =
        !run->spec.stepper->adaptive && t < run->now.t + h && run->summary.state != HN_RUN_FAILED;
    return ahead_allowed ? side_step(run, &run->now, t) : HN_ERR_INPUT;
}

static void fill_forces(hn_run *run, double t, hn_sample *out) {
    hn_accel_info info = {0};
    if (hn_run_accelerations(run, t, run->at_q, run->at_v, run->at_a, run->sample_lambda, &info) ==
        HN_OK) {
        hn_system_rates_to_user(run->sys, run->at_a, run->sample_a);
    } else {
        for (int i = 0; i < run->info.n_user; i++) {
            run->sample_a[i] = nan("");
        }
        for (int i = 0; i < run->info.nc; i++) {
            run->sample_lambda[i] = nan("");
        }
    }
    out->pivot_ratio = info.pivot_ratio;
    out->rank = info.rank;
}

hn_status hn_run_sample(hn_run *run, double t, hn_sample *out) {
    if (!isfinite(t)) {
        return HN_ERR_INPUT;
    }
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
    fill_forces(run, t, out);
    hn_run_measure(run, t, run->at_q, run->at_v, &out->gap, &out->velocity_gap, &out->kinetic,
                   &out->potential);
    out->energy = out->kinetic + out->potential;
    out->energy_change = out->energy - run->watch.start_energy;
    hn_eval_run(run->points, t, run->at_q, run->at_v);
    memcpy(run->sample_points, hn_eval_get(run->points, HN_TERM_POINTS),
           3 * (size_t)run->info.n_points * sizeof(double));
    return HN_OK;
}
