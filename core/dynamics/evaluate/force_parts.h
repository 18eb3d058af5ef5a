// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_FORCE_PARTS_H
#define HN_DYNAMICS_FORCE_PARTS_H
// The forces of a system taken apart:
//
//     f = tau - h - g                                                                          (1)
//     h = d/dt (T_v) at a = 0 - T_q G  (+ omega x T_omega for each ball)   quadratic in v      (2)
//     g = V_q G                                                           gravity, springs     (3)
//
// tau is what remains: motors, dampers, forces. (2) and (3) come from the energies by
// differentiation and owe nothing to the recursion that f comes from, so that f + h + g = 0 where
// there are no loads is a check of both.
// Source: Lagrange's equations, for the velocities of balls in Hamel's form (Bloch, Marsden &
// Zenkov 2009, section 2).

#include "dynamics/compile/system.h"

typedef struct hn_force_parts hn_force_parts;

/// Memory from `arena`, the tape owned by it. It adds nodes to the graph, see system.h. Fails:
/// HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_force_parts_create(const hn_system *sys, hn_arena *arena,
                                              hn_force_parts **out);
void hn_force_parts_free(hn_force_parts *p); ///< NULL is legal
/// Evaluates h and g at a state. Allocates nothing.
void hn_force_parts_run(hn_force_parts *p, double t, const double *q, const double *v);
const double *hn_force_parts_h(const hn_force_parts *p); ///< nv, of the last run
const double *hn_force_parts_g(const hn_force_parts *p); ///< nv
#endif
