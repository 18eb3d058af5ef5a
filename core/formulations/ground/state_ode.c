// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/state_ode.h"

#include "formulations/ground/accel_newton.h"

#include "dynamics/compile/coordinates.h"
#include "formulations/ground/flops.h"

#include <stdio.h>
#include <string.h>

hn_status hn_state_ode_init(hn_state_ode *ode, const hn_system *sys, hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    ode->sys = sys;
    ode->nq = info.nq;
    ode->nv = info.nv;
    ode->nc = info.nc;
    ode->arena = arena;
    ode->unit = hn_arena_doubles(arena, (size_t)info.nq);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

void hn_state_ode_destroy(hn_state_ode *ode) {
    hn_accel_jacobian_free(ode->slopes);
    ode->slopes = NULL;
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    const hn_state_ode *ode = self;
    (void)t;
    hn_system_kinematics(ode->sys, y, y + ode->nq, pos_dot);
    return HN_OK;
}

// ---- derivatives, for implicit integrators ----

static hn_accel_law law_of(const hn_state_ode *ode) {
    return ode->law ? ode->law(ode) : (hn_accel_law){0};
}

static hn_status prepare(void *self) {
    hn_state_ode *ode = self;
    // alpha and beta may be changed while running
    const hn_accel_law law = {ode->law != NULL, ode->law != NULL, law_of(ode).give};
    return ode->slopes ? HN_OK : hn_accel_jacobian_create(ode->sys, &law, ode->arena, &ode->slopes);
}

static hn_status take_slopes(void *self, double t, const double *y) {
    hn_state_ode *ode = self;
    const hn_accel_law law = law_of(ode);
    hn_status status = prepare(self);
    HN_THEN(status, hn_accel_jacobian_at(ode->slopes, t, y, y + ode->nq, &law));
    if (status != HN_OK) {
        snprintf(ode->why, sizeof ode->why, "derivatives of the accelerations at t = %.6g s: %s", t,
                 hn_status_text(status));
    }
    return status;
}

static hn_status jacobian(void *self, double t, const double *y, double *jac) {
    hn_state_ode *ode = self;
    HN_TRY(take_slopes(self, t, y));
    return hn_accel_jacobian_fill(ode->slopes, jac);
}

static hn_status factor(void *self, int which, double re, double im) {
    const hn_state_ode *ode = self;
    return hn_accel_jacobian_factor(ode->slopes, which, re, im);
}

static void solve(void *self, int parts, double *const *x) {
    const hn_state_ode *ode = self;
    hn_accel_jacobian_solve(ode->slopes, parts, x);
}

static const hn_ode_newton newton = {take_slopes, factor, solve};

// ---- a formulation's table ----

void hn_state_ode_get(void *self, hn_status (*rhs)(void *, double, const double *, double *),
                      hn_ode *out) {
    const hn_state_ode *ode = self;
    *out = (hn_ode){.n_pos = ode->nq,
                    .n_vel = ode->nv,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics,
                    .jacobian = jacobian,
                    .newton = &newton,
                    .is_angle = hn_system_angles(ode->sys),
                    .prepare = prepare};
}

hn_status hn_state_ode_set_state(void *self, double t, const double *q, const double *v,
                                 double *y) {
    const hn_state_ode *ode = self;
    (void)t;
    memcpy(y, q, (size_t)ode->nq * sizeof *y);
    memcpy(y + ode->nq, v, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_state_ode_get_state(void *self, double t, const double *y, double *q, double *v) {
    const hn_state_ode *ode = self;
    (void)t;
    memcpy(q, y, (size_t)ode->nq * sizeof *y);
    memcpy(v, y + ode->nq, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_state_ode_after_step(void *self, double t, double *y, int *changed) {
    const hn_state_ode *ode = self;
    (void)t;
    *changed = hn_system_normalise(ode->sys, y);
    return HN_OK;
}

void hn_state_ode_add_cost(const void *self, hn_cost *cost) {
    const hn_state_ode *ode = self;
    hn_cost_add(cost, &ode->cost);
    if (ode->slopes) {
        cost->evals += hn_accel_jacobian_evals(ode->slopes);
        cost->ops += hn_accel_jacobian_ops(ode->slopes);
    }
}

const char *hn_state_ode_why(const void *self) {
    const hn_state_ode *ode = self;
    return ode->why[0] ? ode->why : NULL;
}
