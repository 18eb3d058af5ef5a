// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_ROW_CHECK_H
#define HN_LINALG_ROW_CHECK_H
// Do the rows of a large sparse J stand on their own? With rows brought to length 1, pivot k of the
// Cholesky factor of J J' is the squared distance of row k from the span of those eliminated
// before. When all are above HN_ROW_CHECK_DISTANCE, every row counts, and the pivoted QR that names
// dependent rows, cubic in their number, is not needed. When one is not, nothing is said.
// Source: Golub & Van Loan 2013, section 5.2; George & Liu 1989 for the order.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

typedef struct hn_row_check hn_row_check;
#define HN_ROW_CHECK_DISTANCE 1e-3

/// For nc rows with entries at (row[k], col[k]), borrowed, no place twice. *out stays NULL when
/// rows are too few or meet too often for this to pay. Fails with HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_row_check_create(hn_arena *arena, int nc, int nv, int n_entries,
                                            const int *row, const int *col, hn_row_check **out);
/// Returns whether every row of J (nc x nv, row-major) is that far from the others, column j in
/// units of unit[j] (nv; NULL: 1). Allocates nothing.
bool hn_row_check_run(hn_row_check *c, const double *J, const double *unit);
/// The same with the n_entries values of J alone, in the sequence of their places.
bool hn_row_check_run_list(hn_row_check *c, const double *list, const double *unit);
double hn_row_check_ops(const hn_row_check *c); ///< arithmetic operations so far

#endif
