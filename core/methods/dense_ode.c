#include "methods/dense_ode.h"

#include "dynamics/blur.h"
#include "linalg/dense.h"
#include "methods/flops.h"

#include <stdio.h>
#include <string.h>

hn_status hn_dense_ode_init(hn_dense_ode *ode, const hn_system *sys, int with_gap, hn_arena *arena,
                            hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    const unsigned gap = with_gap ? HN_TERM_PHI | HN_TERM_PHI_T : 0;
    ode->sys = sys;
    ode->arena = arena;
    ode->unit = hn_arena_doubles(arena, (size_t)info.nq);
    ode->nq = info.nq;
    ode->nv = info.nv;
    ode->nc = info.nc;
    const hn_status status = hn_eval_create(
        sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA | gap, arena, &ode->eval);
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "the equations cannot be compiled: %s",
                           hn_status_text(status));
    }
    ode->M = hn_eval_get(ode->eval, HN_TERM_M);
    ode->f = hn_eval_get(ode->eval, HN_TERM_F);
    ode->J = hn_eval_get(ode->eval, HN_TERM_J);
    ode->gamma = hn_eval_get(ode->eval, HN_TERM_GAMMA);
    ode->n_M = hn_eval_pattern(ode->eval, HN_TERM_M, &ode->M_row, &ode->M_col);
    ode->n_J = hn_eval_pattern(ode->eval, HN_TERM_J, &ode->J_row, &ode->J_col);
    ode->phi = with_gap ? hn_eval_get(ode->eval, HN_TERM_PHI) : NULL;
    ode->phi_t = with_gap ? hn_eval_get(ode->eval, HN_TERM_PHI_T) : NULL;
    return HN_OK;
}

void hn_dense_ode_destroy(void *self) {
    hn_dense_ode *ode = self;
    hn_eval_free(ode->eval);
    hn_accel_jacobian_free(ode->slopes);
    ode->eval = NULL;
    ode->slopes = NULL;
}

void hn_dense_ode_pull(const hn_dense_ode *ode, const double *v, double omega, double xi,
                       double *out) {
    hn_dense_ode_rows(ode, v, out);
    for (int i = 0; i < ode->nc; i++) {
        const double rate = out[i] + ode->phi_t[i];
        out[i] = ode->gamma[i] + 2 * xi * omega * rate + omega * omega * ode->phi[i];
    }
}

double hn_dense_ode_blur(const hn_dense_ode *ode, const double *v, double *rate, double *size) {
    const hn_blur_terms at = {.n_J = ode->n_J,
                              .row = ode->J_row,
                              .col = ode->J_col,
                              .J = ode->J,
                              .phi = ode->phi,
                              .phi_t = ode->phi_t};
    return hn_blur_of(hn_blur_gap(ode->sys, &at, v, rate, size));
}

void hn_dense_ode_rows(const hn_dense_ode *ode, const double *x, double *y) {
    const size_t nv = (size_t)ode->nv;
    memset(y, 0, (size_t)ode->nc * sizeof *y);
    for (int e = 0; e < ode->n_J; e++) {
        const size_t i = (size_t)ode->J_row[e], j = (size_t)ode->J_col[e];
        y[i] += ode->J[i * nv + j] * x[j];
    }
}

void hn_dense_ode_add_rows(const hn_dense_ode *ode, const double *y, double *x) {
    const size_t nv = (size_t)ode->nv;
    for (int e = 0; e < ode->n_J; e++) {
        const size_t i = (size_t)ode->J_row[e], j = (size_t)ode->J_col[e];
        x[j] += ode->J[i * nv + j] * y[i];
    }
}

const char *hn_dense_ode_name(const hn_dense_ode *ode, int i) {
    if (i >= hn_system_get_info(ode->sys).n_user) {
        return "?";
    }
    return hn_system_scene(ode->sys)->coordinates[hn_system_user_coordinate(ode->sys, i)].name;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    hn_dense_ode *ode = self;
    const double *q = hn_unit_positions(ode->sys, y, ode->unit), *v = y + ode->nq;
    ode->cost.evals++;
    hn_eval_run(ode->eval, t, q, v);
    const hn_status status = ode->accelerate(self, t, v, ydot + ode->nq);
    if (status != HN_OK) {
        return status;
    }
    if (!hn_all_finite(ode->nv, ydot + ode->nq)) {
        snprintf(ode->why, sizeof ode->why, "the accelerations at t = %.6g s are not finite", t);
        return HN_ERR_DIVERGED;
    }
    hn_system_kinematics(ode->sys, y, v, ydot);
    return HN_OK;
}

static hn_status kinematics(void *self, double t, const double *y, double *pos_dot) {
    const hn_dense_ode *ode = self;
    (void)t;
    hn_system_kinematics(ode->sys, y, y + ode->nq, pos_dot);
    return HN_OK;
}

// --- derivatives, for implicit integrators ----------------------------------------------------------------------

static hn_accel_law law_of(const hn_dense_ode *ode) {
    return ode->law ? ode->law(ode) : (hn_accel_law){0};
}

static hn_status prepare(void *self) {
    hn_dense_ode *ode = self;
    // alpha and beta may be changed while running
    const hn_accel_law law = {ode->law != NULL, ode->law != NULL, law_of(ode).give};
    return ode->slopes ? HN_OK : hn_accel_jacobian_create(ode->sys, &law, ode->arena, &ode->slopes);
}

static hn_status take_slopes(void *self, double t, const double *y) {
    hn_dense_ode *ode = self;
    const hn_accel_law law = law_of(ode);
    hn_status status = prepare(self);
    if (status == HN_OK) {
        status = hn_accel_jacobian_at(ode->slopes, t, y, y + ode->nq, &law);
    }
    if (status != HN_OK) {
        snprintf(ode->why, sizeof ode->why, "derivatives of the accelerations at t = %.6g s: %s", t,
                 hn_status_text(status));
    }
    return status;
}

static hn_status jacobian(void *self, double t, const double *y, double *jac) {
    hn_dense_ode *ode = self;
    const hn_status status = take_slopes(self, t, y);
    return status == HN_OK ? hn_accel_jacobian_fill(ode->slopes, jac) : status;
}

static hn_status factor(void *self, int which, double re, double im) {
    const hn_dense_ode *ode = self;
    return hn_accel_jacobian_factor(ode->slopes, which, re, im);
}

static void solve(void *self, int parts, double *const *x) {
    const hn_dense_ode *ode = self;
    hn_accel_jacobian_solve(ode->slopes, parts, x);
}

static const hn_ode_newton newton = {take_slopes, factor, solve};

void hn_dense_ode_get(void *self, hn_ode *out) {
    const hn_dense_ode *ode = self;
    *out = (hn_ode){.n_pos = ode->nq,
                    .n_vel = ode->nv,
                    .self = self,
                    .rhs = rhs,
                    .kinematics = kinematics,
                    .jacobian = jacobian,
                    .newton = &newton,
                    .prepare = prepare};
}

hn_status hn_dense_ode_set_state(void *self, double t, const double *q, const double *v,
                                 double *y) {
    const hn_dense_ode *ode = self;
    (void)t;
    memcpy(y, q, (size_t)ode->nq * sizeof *y);
    memcpy(y + ode->nq, v, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_dense_ode_get_state(void *self, double t, const double *y, double *q, double *v) {
    const hn_dense_ode *ode = self;
    (void)t;
    memcpy(q, y, (size_t)ode->nq * sizeof *y);
    memcpy(v, y + ode->nq, (size_t)ode->nv * sizeof *y);
    return HN_OK;
}

hn_status hn_dense_ode_after_step(void *self, double t, double *y, int *changed) {
    const hn_dense_ode *ode = self;
    (void)t;
    *changed = hn_system_normalise(ode->sys, y);
    return HN_OK;
}

void hn_dense_ode_add_cost(const void *self, hn_cost *cost) {
    const hn_dense_ode *ode = self;
    hn_cost_add(cost, &ode->cost);
    cost->ops += (double)ode->cost.evals * hn_eval_info(ode->eval).ops;
    if (ode->slopes) {
        cost->evals += hn_accel_jacobian_evals(ode->slopes);
        cost->ops += hn_accel_jacobian_ops(ode->slopes);
    }
}

const char *hn_dense_ode_why(const void *self) {
    const hn_dense_ode *ode = self;
    return ode->why[0] ? ode->why : NULL;
}
