#include "methods/accel_ode.h"

#include "methods/flops.h"

#include <stdio.h>
#include <string.h>

hn_status hn_accel_ode_init(hn_accel_ode *ode, const hn_system *sys, int baumgarte,
                            hn_solver solver, hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    const hn_accel_opts opts = {.baumgarte = baumgarte, .want_lambda = 0, .solver = solver};
    ode->sys = sys;
    ode->baumgarte = baumgarte;
    ode->arena = arena;
    ode->unit = hn_arena_doubles(arena, (size_t)info.nq);
    ode->nq = info.nq;
    ode->nv = info.nv;
    ode->nc = info.nc;
    const hn_status status = hn_accel_create(sys, &opts, arena, &ode->accel);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "accelerations cannot be compiled: %s",
                           hn_status_text(status));
    }
    return HN_OK;
}

void hn_accel_ode_destroy(void *self) {
    hn_accel_ode *ode = self;
    hn_accel_free(ode->accel);
    hn_accel_jacobian_free(ode->slopes);
    ode->accel = NULL;
    ode->slopes = NULL;
}

static void tell_failure(hn_accel_ode *ode, hn_status status, double t) {
    const char *refusal = hn_accel_refusal(ode->accel);
    snprintf(ode->why, sizeof ode->why, "accelerations at t = %.6g s: %s", t,
             refusal ? refusal : hn_status_text(status));
}

hn_status hn_accel_ode_rhs(void *self, double t, const double *y, double *ydot) {
    hn_accel_ode *ode = self;
    const double *q = hn_unit_positions(ode->sys, y, ode->unit), *v = y + ode->nq;
    const hn_status status =
        hn_accel_eval(ode->accel, t, q, v, ode->alpha, ode->beta, ydot + ode->nq, NULL, NULL);
    ode->cost.evals++;
    if (status != HN_OK) {
        tell_failure(ode, status, t);
        return status;
    }
    hn_system_kinematics(ode->sys, y, v, ydot);
    return HN_OK;
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    const hn_accel_ode *ode = self;
    (void)t;
    hn_system_kinematics(ode->sys, y, y + ode->nq, pos_dot);
    return HN_OK;
}

// --- derivatives, for implicit integrators ----------------------------------------------------------------------

static hn_status prepare(void *self) {
    hn_accel_ode *ode = self;
    // alpha and beta may be changed while running
    const hn_accel_law law = {ode->baumgarte, ode->baumgarte, 0};
    return ode->slopes ? HN_OK : hn_accel_jacobian_create(ode->sys, &law, ode->arena, &ode->slopes);
}

static hn_status take_slopes(void *self, double t, const double *y) {
    hn_accel_ode *ode = self;
    hn_status status = prepare(self);
    if (status == HN_OK) {
        const hn_accel_law law = {ode->baumgarte ? ode->alpha : 0, ode->baumgarte ? ode->beta : 0,
                                  0};
        status = hn_accel_jacobian_at(ode->slopes, t, y, y + ode->nq, &law);
    }
    if (status != HN_OK) {
        snprintf(ode->why, sizeof ode->why, "derivatives of the accelerations at t = %.6g s: %s", t,
                 hn_status_text(status));
    }
    return status;
}

static hn_status jacobian(void *self, double t, const double *y, double *jac) {
    hn_accel_ode *ode = self;
    const hn_status status = take_slopes(self, t, y);
    return status == HN_OK ? hn_accel_jacobian_fill(ode->slopes, jac) : status;
}

static hn_status factor(void *self, int which, double re, double im) {
    const hn_accel_ode *ode = self;
    return hn_accel_jacobian_factor(ode->slopes, which, re, im);
}

static void solve(void *self, int parts, double *const *x) {
    const hn_accel_ode *ode = self;
    hn_accel_jacobian_solve(ode->slopes, parts, x);
}

static const hn_ode_newton newton = {take_slopes, factor, solve};

void hn_accel_ode_get(void *self, hn_ode *out) {
    const hn_accel_ode *ode = self;
    *out = (hn_ode){.n_pos = ode->nq,
                    .n_vel = ode->nv,
                    .self = self,
                    .rhs = hn_accel_ode_rhs,
                    .kinematics = kinematics,
                    .jacobian = jacobian,
                    .newton = &newton,
                    .prepare = prepare};
}

hn_status hn_accel_ode_set_state(void *self, double t, const double *q, const double *v,
                                 double *y) {
    const hn_accel_ode *ode = self;
    (void)t;
    memcpy(y, q, (size_t)ode->nq * sizeof *y);
    memcpy(y + ode->nq, v, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_accel_ode_get_state(void *self, double t, const double *y, double *q, double *v) {
    const hn_accel_ode *ode = self;
    (void)t;
    memcpy(q, y, (size_t)ode->nq * sizeof *y);
    memcpy(v, y + ode->nq, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_accel_ode_after_step(void *self, double t, double *y, int *changed) {
    const hn_accel_ode *ode = self;
    (void)t;
    *changed = hn_system_normalise(ode->sys, y);
    return HN_OK;
}

void hn_accel_ode_add_cost(const void *self, hn_cost *cost) {
    const hn_accel_ode *ode = self;
    const long long evals = hn_accel_count(ode->accel);
    const long long dense = hn_accel_fallbacks(ode->accel);
    hn_cost_add(cost, &ode->cost);
    cost->factorisations += evals;
    cost->solves += evals;
    cost->fallbacks += dense;
    cost->refinements += hn_accel_refinements(ode->accel);
    cost->ops += hn_accel_ops(ode->accel);
    if (ode->slopes) {
        cost->evals += hn_accel_jacobian_evals(ode->slopes);
        cost->ops += hn_accel_jacobian_ops(ode->slopes);
    }
}

const char *hn_accel_ode_why(const void *self) {
    const hn_accel_ode *ode = self;
    return ode->why[0] ? ode->why : NULL;
}
