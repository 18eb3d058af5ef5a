// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_PENALISED_H
#define HN_FORMULATIONS_PENALISED_H
// Common part of penalty and augmented Lagrangian: the matrix M + a J' J, which is positive
// definite however many rows depend on each other, as long as no direction is both massless and
// free. It is factored sparse: two coordinates meet in it where a body or a closure row touches
// both.

#include "formulations/ground/dense_ode.h"
#include "linalg/sparse_spd.h"

/// Options of both formulations, the first in their tables; they can be changed while running.
enum { HN_PENALISED_A, HN_PENALISED_OMEGA, HN_PENALISED_XI, HN_PENALISED_OPTIONS };

typedef struct hn_penalised {
    hn_dense_ode ode; ///< first: see dense_ode.h
    double a, omega, xi;
    hn_sparse_spd *spd;
    int n_G;                 ///< entries of G = M + a J' J, lower triangle
    int *G_row, *G_col;      ///< where they are
    int *from_M;             ///< n_M: the entry of G that an entry of M adds to
    int n_pairs, (*pair)[3]; ///< entry of G, and the two entries of J whose product adds to it
    double *G, *scale;       ///< n_G, nv: D G D = L L' with unit diagonal
    double *pull;            ///< nc: gamma + 2 xi omega (J v + phi_t) + omega^2 phi
    double *work;            ///< nc
    double *size;            ///< nc
} hn_penalised;

/// Memory and terms; `options` begin with the three above.
HN_MUST_CHECK hn_status hn_penalised_init(hn_penalised *p, const hn_system *sys,
                                          const double *options, hn_arena *arena, hn_diag *diag);
/// Returns the median of J_i diag(M)^-1 J_i' at the terms last evaluated, the scale of J M^-1 J'
/// without a solve: one over the typical mass at the loops. 0 where no constraint moves a mass.
double hn_penalised_typical_mobility(hn_penalised *p);
/// Factors M + weight J' J at the terms last evaluated. Fails: HN_ERR_SINGULAR, told in
/// ode.base.why.
HN_MUST_CHECK hn_status hn_penalised_factor(hn_penalised *p, double t, double weight);
/// x <- (M + weight J' J)^-1 x, x (nv).
void hn_penalised_solve(hn_penalised *p, double *x);
hn_status hn_penalised_set(void *self, int option, double value);

#endif
