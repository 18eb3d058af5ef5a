// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_LAGRANGE_TERMS_H
#define HN_INTEGRATORS_LAGRANGE_TERMS_H
// A system read as Lagrange's equations of the second kind, for variational integrators:
//
//     d/dt (M v) = L_q + Q_v + J' lambda,     L_q = d/dq (1/2 v' M v) + f(q, 0, t)            (1)
//     Q_v = f(q, v, t) - f(q, 0, t) + (dM/dt) v - d/dq (1/2 v' M v)                           (2)
//
// Derivatives by q are taken along the speeds: along G of q' = G v. For the three speeds of a ball,
// measured in its own axes, the left of (1) and the middle of (2) gain omega x p, p being its three
// entries of M v (Hamel's form).
//
// Q_v is what depends on speed and comes from no Lagrangian of this form: dampers, friction, air,
// gyroscopic terms. It vanishes identically for rigid bodies under weight, springs and forces of
// place and time.

#include "base/arena.h"
#include "dynamics/compile/system.h"

#include <stdbool.h>

typedef struct hn_lagrange hn_lagrange;

/// Memory from `arena`, the tapes owned. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_lagrange_create(const hn_system *sys, hn_arena *arena,
                                           hn_lagrange **out);
void hn_lagrange_free(hn_lagrange *l); ///< NULL is legal
/// Returns whether no entry of M depends on q or t.
bool hn_lagrange_mass_is_constant(const hn_lagrange *l);
/// Returns whether Q_v differs from zero at some of a few states with coordinates and speeds of
/// order one:
/// more than rounding makes it.
bool hn_lagrange_has_dissipation(hn_lagrange *l);

/// All below are borrowed from the object and stay until the next call of the same function.
/// out: M v (nv) and L_q (nv) at (t, q, v).
void hn_lagrange_forces(hn_lagrange *l, double t, const double *q, const double *v,
                        const double **momentum, const double **force);
/// M (nv x nv) and B = (M v)_q (nv x nv, row i: derivative of entry i along the speeds).
void hn_lagrange_matrices(hn_lagrange *l, double t, const double *q, const double *v,
                          const double **M, const double **B);
/// Entries of M + (M v)_q that are not identically zero: their number, rows and columns (borrowed).
int hn_lagrange_pattern(const hn_lagrange *l, const int **rows, const int **cols);
/// Q_v (nv).
const double *hn_lagrange_dissipation(hn_lagrange *l, double t, const double *q, const double *v);
double hn_lagrange_ops(const hn_lagrange *l); ///< arithmetic operations so far

#endif
