// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SQUARE_H
#define HN_LINALG_SQUARE_H
// Square systems without symmetry: Newton matrices of implicit integrators, saddle systems with the
// Jacobian of two poses.
//
//     A x = b,  R A C = P' L U  with R, C powers of two that bring rows and columns to about
//                               unit size                                                       (1)
//
// LU with partial pivoting of the equilibrated matrix, so that metres, radians and newtons weigh
// alike.
// Source: Higham 2002, Accuracy and Stability of Numerical Algorithms, chapter 9.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

/// One factorisation and its memory. Plain data: read pivot_ratio.
typedef struct hn_square {
    int n_max, n;
    double *lu;        ///< in: A (n x n, row-major); out: L below the diagonal, U on and above it
    double *row, *col; ///< R and C of (1)
    int *perm;         ///< row k of the factor is row perm[k] of A
    double *work;      ///< n
    /// smallest pivot / largest [-], without small pivots that no cancellation made small
    double pivot_ratio;
} hn_square;

/// Below this pivot_ratio the matrix counts as singular.
#define HN_SQUARE_SINGULAR 1e-13

/// Memory for up to n_max x n_max; returns false when memory is out.
HN_MUST_CHECK bool hn_square_init(hn_square *s, hn_arena *arena, int n_max);
/// Factors s->lu, filled by the caller as n x n. Fails: HN_ERR_DIVERGED (an entry is not finite),
/// HN_ERR_SINGULAR.
/// Cost: 2 n^3 / 3 operations. Allocates nothing.
HN_MUST_CHECK hn_status hn_square_factor(hn_square *s, int n);
/// x <- A^-1 x, x (n). Cost: 2 n^2 operations.
void hn_square_solve(const hn_square *s, double *x);

#endif
