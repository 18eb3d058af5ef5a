// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_EXCHANGED_ROWS_H
#define HN_CLASS_EXCHANGED_ROWS_H
// Rows or columns of a matrix that stand in another order than they should.

#include <stdbool.h>

/// The matrix at several states: entry i at state k is given[k * rows * columns + i], row-major.
typedef struct hn_two_matrices {
    const double *given, *right;
    int states, rows, columns; ///< columns 1: a vector
    double allowed;            ///< difference that rounding explains
} hn_two_matrices;

/// Writes "rows 0 and 1 are exchanged", counted from `first`, or that they stand in another order.
/// Both at once, as where coordinates were taken in another order: "rows and columns 0 and 1 ...".
/// Returns whether that is what is wrong, and all that is wrong.
bool hn_exchanged_rows_find(const hn_two_matrices *m, int first, char out[96]);

#endif
