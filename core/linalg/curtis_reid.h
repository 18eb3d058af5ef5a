// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_CURTIS_REID_H
#define HN_LINALG_CURTIS_REID_H
// Scaling of a square matrix by powers of two that bring its entries as close to 1 as they can be,
// in the least-squares sense of their logarithms:
//
//     minimise  sum over a_ij != 0 of  (log2 |a_ij| + r_i + c_j)^2                            (1)
//
// Unlike scaling by the largest entries it finds the units in which masses of 1e-12 kg, lengths of
// 1e-4 m and their multipliers are all of size 1: a saddle matrix [M -J'; J 0] in small units has
// M far below J in every row and column, and looks singular.
// Source: Curtis & Reid 1972, On the automatic scaling of matrices for Gaussian elimination.

#include "base/arena.h"

/// Finds r and c (n each) of (1), rounded to whole numbers, in a few alternating sweeps.
///
/// parts   1: real, 2: complex (re, im)
/// start, row   places of a column-wise sparse matrix, see compressed.h; NULL: dense, row-major
/// values  the entries, parts each
/// work    n doubles of scratch each
void hn_curtis_reid(int n, int parts, const int *start, const int *row, const double *values,
                    double *r, double *c, double *work_sum, int *work_count);

#endif
