// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_ACCEL_ODE_H
#define HN_FORMULATIONS_ACCEL_ODE_H
// Common part of index-1, Baumgarte and projection: the state y = (q, v) in system coordinates and
// the right-hand side
//
//  q' = G(q) v, v' = a from K [a; -lambda] = [f; -gamma - 2 alpha (J v + phi_t) - beta^2 phi] (1)
//
// A formulation's instance begins with an hn_accel_ode, so that the functions below and those of
// hn_state_ode fit its table.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "formulations/ground/state_ode.h"

#include <stdbool.h>

typedef struct hn_accel_ode {
    hn_state_ode base; // first
    hn_accel *accel;
    double alpha, beta; ///< [1/s], used with baumgarte
} hn_accel_ode;

/// Compiles the accelerations; baumgarte: with the feedback of gap and velocity violation. Fails:
/// HN_ERR_MEMORY, reported in diag.
HN_MUST_CHECK hn_status hn_accel_ode_init(hn_accel_ode *ode, const hn_system *sys, bool baumgarte,
                                          hn_solver solver, hn_arena *arena, hn_diag *diag);
/// The option "solver" of the formulations that use this; the value is an hn_solver.
#define HN_ACCEL_ODE_SOLVER_OPTION                                                            \
    {                                                                                         \
        .key = "solver", .max = HN_SOLVER_COUNT - 1, .choices = hn_solver_names,              \
        .n_choices = HN_SOLVER_COUNT,                                                         \
        .about = "linear solver of the accelerations; auto: the tape, refined or least-norm " \
                 "where needed"                                                               \
    }
void hn_accel_ode_destroy(void *self);
void hn_accel_ode_get(void *self, hn_ode *out);
void hn_accel_ode_add_cost(const void *self, hn_cost *cost);
long long hn_accel_ode_fallbacks(const void *self);

#endif
