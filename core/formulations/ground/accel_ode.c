// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/accel_ode.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"

#include <stdbool.h>
#include <stdio.h>

static hn_accel_law law(const void *self) {
    const hn_accel_ode *ode = self;
    return (hn_accel_law){ode->alpha, ode->beta, 0};
}

hn_status hn_accel_ode_init(hn_accel_ode *ode, const hn_system *sys, bool baumgarte,
                            hn_solver solver, hn_arena *arena, hn_diag *diag) {
    const hn_accel_opts opts = {.baumgarte = baumgarte, .want_lambda = 0, .solver = solver};
    ode->base.law = baumgarte ? law : NULL;
    hn_status status = hn_state_ode_init(&ode->base, sys, arena);
    HN_THEN(status, hn_accel_create(sys, &opts, arena, &ode->accel));
    if (status != HN_OK) {
        return hn_diag_set(diag, status, NULL, NULL, "accelerations cannot be compiled: %s",
                           hn_status_text(status));
    }
    return HN_OK;
}

void hn_accel_ode_destroy(void *self) {
    hn_accel_ode *ode = self;
    hn_accel_free(ode->accel);
    hn_state_ode_destroy(&ode->base);
    ode->accel = NULL;
}

static void tell_failure(hn_accel_ode *ode, hn_status status, double t) {
    const char *refusal = hn_accel_refusal(ode->accel);
    snprintf(ode->base.why, sizeof ode->base.why, "accelerations at t = %.6g s: %s", t,
             refusal ? refusal : hn_status_text(status));
}

static hn_status evaluate_rhs(void *self, double t, const double *y, double *ydot) {
    hn_accel_ode *ode = self;
    const int nq = ode->base.nq;
    const bool plain = nq == ode->base.nv; // no quaternion to bring back to length 1
    const double *q = plain ? y : hn_unit_positions(ode->base.sys, y, ode->base.unit), *v = y + nq;
    const hn_status status =
        hn_accel_eval(ode->accel, t, q, v, ode->alpha, ode->beta, ydot + nq, NULL, NULL);
    ode->base.cost.evals++;
    if (status != HN_OK) {
        tell_failure(ode, status, t);
        return status;
    }
    if (!plain) {
        hn_system_kinematics(ode->base.sys, y, v, ydot);
        return HN_OK;
    }
    for (int i = 0; i < nq; i++) { // the rates are the velocities; for a few, quicker than calls
        ydot[i] = v[i];
    }
    return HN_OK;
}

void hn_accel_ode_get(void *self, hn_ode *out) {
    hn_state_ode_get(self, evaluate_rhs, out);
}

void hn_accel_ode_add_cost(const void *self, hn_cost *cost) {
    const hn_accel_ode *ode = self;
    const long long evals = hn_accel_count(ode->accel);
    const long long dense = hn_accel_fallbacks(ode->accel);
    hn_state_ode_add_cost(self, cost);
    cost->factorisations += evals;
    cost->solves += evals;
    cost->fallbacks += dense;
    cost->refinements += hn_accel_refinements(ode->accel);
    cost->ops += hn_accel_ops(ode->accel);
}

long long hn_accel_ode_fallbacks(const void *self) {
    const hn_accel_ode *ode = self;
    return hn_accel_fallbacks(ode->accel);
}
