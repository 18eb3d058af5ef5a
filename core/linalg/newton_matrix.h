// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_NEWTON_MATRIX_H
#define HN_LINALG_NEWTON_MATRIX_H
// Matrices of Newton's method, real or complex, that are filled and factored again and again. They
// are filled entry by entry; an entry that is put twice is a sum. Small and full ones are dense
// (linalg/square.h, linalg/lu.h); large ones with few entries are given to SuiteSparse KLU: block
// triangular form, approximate minimum degree, threshold pivoting. The order and the pivots of the
// first factorisation stay as long as the same places are put in the same sequence and the factors
// do not grow, so a factorisation costs what L and U hold: linearly in the number of loops of a
// chain.
// Source: Davis & Palamadai Natarajan 2010, algorithm 907 (KLU).

#include "base/arena.h"
#include "base/status.h"
#include "linalg/lu.h"

#include <stdbool.h>

typedef struct hn_newton_matrix hn_newton_matrix;

/// From this size on a matrix with at most a quarter of its entries in use is sparse.
enum { HN_NEWTON_SPARSE_FROM = 24 };
/// Returns whether a matrix of size n with so many entries is factored sparsely.
bool hn_newton_matrix_wants_sparse(int n, long long n_entries);

typedef enum hn_number_field { HN_REAL, HN_COMPLEX } hn_number_field;

/// Room for matrices up to n_max; sparse ones with up to entries_max puts. Memory from `arena`,
/// what the library allocates is freed by hn_newton_matrix_free. NULL when memory is out.
HN_MUST_CHECK hn_newton_matrix *hn_newton_matrix_create(hn_arena *arena, hn_number_field field,
                                                        bool sparse, int n_max, int entries_max);
void hn_newton_matrix_free(hn_newton_matrix *m); ///< NULL is legal

/// Begins a matrix of size n, all zero.
void hn_newton_matrix_begin(hn_newton_matrix *m, int n);
/// Adds to entry (row, col). A real matrix has `re` alone.
void hn_newton_matrix_put(hn_newton_matrix *m, int row, int col, double re, double im);
/// Copies the entries that were put (n x n, row-major), before the matrix is factored. For real
/// matrices, for reports.
void hn_newton_matrix_copy(const hn_newton_matrix *m, double *out);
/// Factors what was put. Fails: HN_ERR_SINGULAR, HN_ERR_DIVERGED (an entry is not finite),
/// HN_ERR_MEMORY. Allocates only when sparse and the places or the pivots are new.
HN_MUST_CHECK hn_status hn_newton_matrix_factor(hn_newton_matrix *m);
/// x <- A^-1 x: n numbers, of a complex matrix n pairs (re, im).
void hn_newton_matrix_solve(hn_newton_matrix *m, double *x);
/// Real arithmetic operations of all factorisations and solutions so far.
double hn_newton_matrix_ops(const hn_newton_matrix *m);
/// Entries of L and U of the last factorisation.
long long hn_newton_matrix_nnz(const hn_newton_matrix *m);

#endif
