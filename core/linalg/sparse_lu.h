// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SPARSE_LU_H
#define HN_LINALG_SPARSE_LU_H
// Sparse LU of a square matrix that is factored again and again with new values in the same places:
//
//     P A Q = L U,   L unit lower triangular                                                (1)
//
// The order is chosen from values once: in each step the column with the fewest entries left, and
// in it the row with the fewest among those within a factor ten of the largest (Markowitz, with
// threshold pivoting). Later factorisations keep the order and the pattern, so they cost what L and
// U hold, linearly for a chain of loops. An entry of L that grows beyond
// HN_SPARSE_LU_GROWTH says that the order has become bad; a new one is chosen at once.
// Source: Markowitz 1957; Duff, Erisman & Reid 2017, Direct Methods for Sparse Matrices, ch. 5 and
// 7.

#include "base/arena.h"
#include "base/status.h"

typedef struct hn_sparse_lu hn_sparse_lu;
#define HN_SPARSE_LU_GROWTH 1e4

/// NULL when memory is out. Matrices up to n_max x n_max with up to entries_max entries.
HN_MUST_CHECK hn_sparse_lu *hn_sparse_lu_create(hn_arena *arena, int n_max, int entries_max);
/// The places of the entries (borrowed no longer than the call); forgets order and factor. No place
/// twice.
void hn_sparse_lu_set_pattern(hn_sparse_lu *lu, int n, int n_entries, const int *row,
                              const int *col);
/// Factors the matrix with these entries, in the order of the pattern. Allocates nothing.
/// Fails: HN_ERR_SINGULAR (a pivot vanishes whatever the order), HN_ERR_DIVERGED (an entry is not
/// finite).
HN_MUST_CHECK hn_status hn_sparse_lu_factor(hn_sparse_lu *lu, const double *values);
/// x (n) = A^-1 b with the last successful factor; b (n) and x may be the same array.
void hn_sparse_lu_solve(const hn_sparse_lu *lu, const double *b, double *x);

double hn_sparse_lu_smallest_pivot(const hn_sparse_lu *lu); ///< |U_kk|; HUGE_VAL for n = 0
double hn_sparse_lu_log_volume(const hn_sparse_lu *lu);     ///< log |det A|
int hn_sparse_lu_sign(const hn_sparse_lu *lu);              ///< of det A
int hn_sparse_lu_nnz(const hn_sparse_lu *lu); ///< entries of L and U, diagonal of U included
/// Arithmetic operations of the last factorisation (an order chosen anew counts as what it did) and
/// of a solve.
double hn_sparse_lu_factor_ops(const hn_sparse_lu *lu);
double hn_sparse_lu_solve_ops(const hn_sparse_lu *lu);

#endif
