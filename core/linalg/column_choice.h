// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_COLUMN_CHOICE_H
#define HN_LINALG_COLUMN_CHOICE_H
// The first columns of a sparse A, in an order that the caller prefers, of which none depends on
// those before: a square and regular part of A where A has full row rank. Column by column, what is
// left of it beside the columns taken is found by elimination, and it is taken where enough is
// left. Costs what the factor holds: linearly for a chain of loops.
// Source: Gilbert & Peierls 1988 (left-looking elimination with pivots by size).

#include "base/arena.h"
#include "base/status.h"

typedef struct hn_column_choice hn_column_choice;

/// For n_entries at (row[k], col[k]), both borrowed, no place twice. NULL when memory is out.
HN_MUST_CHECK hn_column_choice *hn_column_choice_create(hn_arena *arena, int rows, int cols,
                                                        int n_entries, const int *row,
                                                        const int *col);
/// Takes columns of the matrix with these entries in the sequence `order` (n_order), each of which
/// at least `tol` of its largest entry is left, into taken (rows). Returns how many: `rows` where A
/// has a regular part, less where it has none or the factor would hold more than is sparse.
/// Allocates nothing.
int hn_column_choice_run(hn_column_choice *c, const double *entry, const int *order, int n_order,
                         double tol, int *taken);

#endif
