#include "methods/accel_ode.h"

#include "methods/flops.h"

#include <stdio.h>
#include <string.h>

hn_status hn_accel_ode_init(hn_accel_ode *ode, const hn_system *sys, int baumgarte,
                            hn_solver solver, hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    const hn_accel_opts opts = {.baumgarte = baumgarte, .want_lambda = 0, .solver = solver};
    ode->sys = sys;
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
    ode->accel = NULL;
}

static void tell_failure(hn_accel_ode *ode, hn_status status, double t) {
    const char *refusal = hn_accel_refusal(ode->accel);
    snprintf(ode->why, sizeof ode->why, "accelerations at t = %.6g s: %s", t,
             refusal ? refusal : hn_status_text(status));
}

hn_status hn_accel_ode_rhs(void *self, double t, const double *y, double *ydot) {
    hn_accel_ode *ode = self;
    const double *q = y, *v = y + ode->nq;
    const hn_status status =
        hn_accel_eval(ode->accel, t, q, v, ode->alpha, ode->beta, ydot + ode->nq, NULL, NULL);
    ode->cost.evals++;
    if (status != HN_OK) {
        tell_failure(ode, status, t);
        return status;
    }
    hn_system_kinematics(ode->sys, q, v, ydot);
    return HN_OK;
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    const hn_accel_ode *ode = self;
    (void)t;
    hn_system_kinematics(ode->sys, y, y + ode->nq, pos_dot);
    return HN_OK;
}

void hn_accel_ode_get(void *self, hn_ode *out) {
    const hn_accel_ode *ode = self;
    *out = (hn_ode){.n_pos = ode->nq,
                    .n_vel = ode->nv,
                    .self = self,
                    .rhs = hn_accel_ode_rhs,
                    .kinematics = kinematics};
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
}

const char *hn_accel_ode_why(const void *self) {
    const hn_accel_ode *ode = self;
    return ode->why[0] ? ode->why : NULL;
}
