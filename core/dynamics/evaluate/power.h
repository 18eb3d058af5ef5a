// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_POWER_H
#define HN_DYNAMICS_POWER_H
// The power that drives, dampers and loads put into a system, beside what its energy T + V holds.
//
// With M a = f + J' lambda, T = v' M v / 2, and D the derivative along q' = G v, v' = 0, t' = 1:
//
//     (T + V)' = v . f + D(T + V) + lambda . (J v)                                             (1)
//     P = v . f + D(T + V) - lambda . phi_t                                                    (2)
//
// J v = -phi_t where the velocities fit the constraints, so P is then the whole of (1). If they
// do not fit, lambda . (J v + phi_t) is work that the method adds by mistake: (2) leaves it out.
// Source: the energy theorem, by Lagrange's equations; (2) needs no list of the loads.

#include "dynamics/compile/system.h"

typedef struct hn_power hn_power;

/// Memory from `arena`, the tape owned by it. It adds nodes to the graph, see system.h. Fails:
/// HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_power_create(const hn_system *sys, hn_arena *arena, hn_power **out);
void hn_power_free(hn_power *p); ///< NULL is legal
/// Returns whether a constraint moves with time: then the power needs multipliers.
bool hn_power_needs_lambda(const hn_power *p);
/// P of (2) at a state [W]; lambda (nc) may be NULL where it is not needed. Allocates nothing.
double hn_power_run(hn_power *p, double t, const double *q, const double *v, const double *lambda);

#endif
