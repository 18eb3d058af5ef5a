// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_GRAM_H
#define HN_LINALG_GRAM_H
// The products of the rows of a sparse A with each other, and their factor:
//
//     G = A A' + shift I                                                                     (1)
//
// for an A (rows x cols) whose entries change and whose places do not. Its cost grows with the
// products of entries that stand in one column: linearly for a chain of loops. Least-norm solutions
// x = A' G^-1 b, damped ones, distances of rows from each other and singular values of A all come
// from it. It squares the condition of A, so it serves rows that stand well apart.
// Source: Golub & Van Loan 2013, section 5.3; George & Liu 1989 for the order.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

typedef struct hn_gram hn_gram;

/// For n_entries at (row[k], col[k]), rising by rows, no place twice; both arrays are borrowed.
/// *out stays NULL where columns are so full that a dense way costs no more. Fails with
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_gram_create(hn_arena *arena, int rows, int cols, int n_entries,
                                       const int *row, const int *col, hn_gram **out);
/// A has these entries (borrowed until the next call). Allocates nothing.
void hn_gram_fill(hn_gram *g, const double *entry);
/// The largest entry on the diagonal of A A'.
double hn_gram_largest(const hn_gram *g);
/// Factors (1). Fails: HN_ERR_SINGULAR when a pivot is not above `tol`, HN_ERR_DIVERGED when an
/// entry is not finite. Allocates nothing.
HN_MUST_CHECK hn_status hn_gram_factor(hn_gram *g, double shift, double tol);
/// x (rows) <- G^-1 x with the last successful factor.
void hn_gram_solve(hn_gram *g, double *x);
/// y (rows) = A x for x (cols), and y (cols) = A' x for x (rows).
void hn_gram_times(const hn_gram *g, const double *x, double *y);
void hn_gram_times_transpose(const hn_gram *g, const double *x, double *y);
/// Smallest and largest singular value of A, from the last factor, made without a shift: by
/// iteration, to about six digits when the extreme values stand apart, and to the spread of a
/// cluster otherwise. Both 0 when A has no row.
void hn_gram_sigma(hn_gram *g, double *sigma_min, double *sigma_max);
/// Arithmetic operations of filling and factoring once.
double hn_gram_factor_ops(const hn_gram *g);

#endif
