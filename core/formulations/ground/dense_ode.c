// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/dense_ode.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/pivot_noise.h"
#include "linalg/dense.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

hn_status hn_dense_ode_init(hn_dense_ode *ode, const hn_system *sys, bool with_gap, hn_arena *arena,
                            hn_diag *diag) {
    const unsigned gap = with_gap ? HN_TERM_PHI | HN_TERM_PHI_T : 0;
    hn_status status = hn_state_ode_init(&ode->base, sys, arena);
    HN_THEN(status, hn_eval_create(sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA | gap,
                                   arena, &ode->eval));
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
    hn_state_ode_destroy(&ode->base);
    ode->eval = NULL;
}

void hn_dense_ode_pull(const hn_dense_ode *ode, const double *v, double omega, double xi,
                       double *out) {
    hn_dense_ode_rows(ode, v, out);
    for (int i = 0; i < ode->base.nc; i++) {
        const double rate = out[i] + ode->phi_t[i];
        out[i] = ode->gamma[i] + 2 * xi * omega * rate + omega * omega * ode->phi[i];
    }
}

double hn_dense_ode_blur(const hn_dense_ode *ode, const double *v, double *rate, double *size) {
    const hn_pivot_noise_terms at = {.n_J = ode->n_J,
                                     .row = ode->J_row,
                                     .col = ode->J_col,
                                     .J = ode->J,
                                     .phi = ode->phi,
                                     .phi_t = ode->phi_t};
    return hn_pivot_noise_of(hn_pivot_noise_gap(ode->base.sys, &at, v, rate, size));
}

void hn_dense_ode_rows(const hn_dense_ode *ode, const double *x, double *y) {
    const size_t nv = (size_t)ode->base.nv;
    memset(y, 0, (size_t)ode->base.nc * sizeof *y);
    for (int e = 0; e < ode->n_J; e++) {
        const size_t i = (size_t)ode->J_row[e], j = (size_t)ode->J_col[e];
        y[i] += ode->J[i * nv + j] * x[j];
    }
}

void hn_dense_ode_add_rows(const hn_dense_ode *ode, const double *y, double *x) {
    const size_t nv = (size_t)ode->base.nv;
    for (int e = 0; e < ode->n_J; e++) {
        const size_t i = (size_t)ode->J_row[e], j = (size_t)ode->J_col[e];
        x[j] += ode->J[i * nv + j] * y[i];
    }
}

const char *hn_dense_ode_name(const hn_dense_ode *ode, int i) {
    if (i >= hn_system_get_info(ode->base.sys).n_user) {
        return "?";
    }
    return hn_system_scene(ode->base.sys)
        ->coordinates[hn_system_user_coordinate(ode->base.sys, i)]
        .name;
}

static hn_status rhs(void *self, double t, const double *y, double *ydot) {
    hn_dense_ode *ode = self;
    const double *q = hn_unit_positions(ode->base.sys, y, ode->base.unit), *v = y + ode->base.nq;
    ode->base.cost.evals++;
    hn_eval_run(ode->eval, t, q, v);
    HN_TRY(ode->accelerate(self, t, v, ydot + ode->base.nq));
    if (!hn_all_finite(ode->base.nv, ydot + ode->base.nq)) {
        snprintf(ode->base.why, sizeof ode->base.why,
                 "the accelerations at t = %.6g s are not finite", t);
        return HN_ERR_DIVERGED;
    }
    hn_system_kinematics(ode->base.sys, y, v, ydot);
    return HN_OK;
}

void hn_dense_ode_get(void *self, hn_ode *out) {
    hn_state_ode_get(self, rhs, out);
}

void hn_dense_ode_add_cost(const void *self, hn_cost *cost) {
    const hn_dense_ode *ode = self;
    hn_state_ode_add_cost(self, cost);
    cost->ops += (double)ode->base.cost.evals * hn_eval_info(ode->eval).ops;
}
