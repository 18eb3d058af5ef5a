// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SPARSE_SPD_H
#define HN_LINALG_SPARSE_SPD_H
// Sparse A = P' L D L' P of a symmetric positive definite matrix whose entries change and whose
// pattern does not. The order (minimum degree) and the pattern of L are found once; a factorisation
// then costs what L holds, linearly for a chain.
// Source: George & Liu 1989, the evolution of the minimum degree ordering; Davis 2005, algorithm
// 849 (rows of L one by one).

#include "base/arena.h"
#include "base/status.h"

typedef struct hn_sparse_spd hn_sparse_spd;

/// For n x n matrices with entries at (row[k], col[k]), row >= col, no place twice; a diagonal
/// entry that is missing is zero. NULL when memory is out.
HN_MUST_CHECK hn_sparse_spd *hn_sparse_spd_create(hn_arena *arena, int n, int n_entries,
                                                  const int *row, const int *col);
/// Factors the matrix with these entries, in the order of the pattern. Allocates nothing. Fails:
/// HN_ERR_SINGULAR when a pivot is not above `tol` (absolute: scale the matrix first),
/// HN_ERR_DIVERGED when an entry is not finite.
HN_MUST_CHECK hn_status hn_sparse_spd_factor(hn_sparse_spd *spd, const double *values, double tol);
/// x (n) <- A^-1 x with the last successful factor.
void hn_sparse_spd_solve(hn_sparse_spd *spd, double *x);
int hn_sparse_spd_nnz(const hn_sparse_spd *spd); ///< entries of L below its diagonal
double hn_sparse_spd_factor_ops(const hn_sparse_spd *spd);
double hn_sparse_spd_solve_ops(const hn_sparse_spd *spd);

#endif
