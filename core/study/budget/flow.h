// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_FLOW_H
#define HN_STUDY_FLOW_H
// The flow of an ordinary differential equation over a short time, to all digits that double
// precision gives: what a step of an integrator is measured against.

#include "base/arena.h"
#include "formulations/ground/formulation.h"

typedef struct hn_flow hn_flow;
/// For equations of n_pos + n_vel unknowns; memory from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_flow_create(int n_pos, int n_vel, hn_arena *arena, hn_flow **out);
/// y at t + h from y at t (h > 0), by Dormand-Prince 8 with steps that keep the local error below
/// `tol` of each entry, and of 1, or as small as rounding of the right-hand side allows. y and
/// y_end may be the same. Fails with the right-hand side's status, HN_ERR_STEP_UNDERFLOW,
/// HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_flow_run(hn_flow *flow, const hn_ode *ode, double tol, double t,
                                    double h, const double *y, double *y_end);

/// Carries derivatives of a flow back: out (n) = A' w, A being the derivative of y' by y, along n
/// displacements of the unknowns, at (t, y).
/// Fails as it has to.
typedef struct hn_flow_slopes {
    int n;
    void *self;
    hn_status (*back)(void *self, double t, const double *y, const double *w, double *out);
} hn_flow_slopes;

typedef struct hn_flow_carrier hn_flow_carrier;
/// For flows of n_pos + n_vel unknowns with n displacements; memory from `arena`, which grows with
/// the number of a flow's steps. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_flow_carrier_create(int n_pos, int n_vel, int n, hn_arena *arena,
                                               hn_flow_carrier **out);
/// w (slopes->n) <- D' w, D being the derivative of y at t + h by y at t: the steps of
/// hn_flow_run(), and then each of them transposed, stage by stage, which is the derivative of what
/// the steps themselves do and needs no second tolerance. Fails as hn_flow_run(), and with the
/// status of slopes->back; HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_flow_carry_back(hn_flow_carrier *carrier, const hn_ode *ode,
                                           const hn_flow_slopes *slopes, double tol, double t,
                                           double h, const double *y, double *w);
#endif
