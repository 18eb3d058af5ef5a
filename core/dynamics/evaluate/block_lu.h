// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_BLOCK_LU_H
#define HN_DYNAMICS_BLOCK_LU_H
// Gaussian elimination of a small square matrix of expressions, by pivots of one or two rows:
//
//     A x = B                                                                                (1)
//
// The order is chosen once, from the structure and from values at one configuration, and serves
// every matrix of the same structure. Pivots that cannot vanish come first: numbers, then entries
// that stand alone in their row or column, then pairs of rows that share their two columns (the two
// equations of a plane loop), whose pivot is their determinant. If there is none of these, the
// sparsest entry of a tenth of its column's largest or more is the pivot (Markowitz 1957).

#include "expr/graph.h"

#include <stdbool.h>

enum { HN_BLOCK_LU_MOST = 12 };

typedef struct hn_block_lu {
    int n, n_blocks;
    int row[HN_BLOCK_LU_MOST], col[HN_BLOCK_LU_MOST]; ///< in order of elimination
    int size[HN_BLOCK_LU_MOST];                       ///< of each block: 1 or 2 rows
    int sign;                                         ///< of the two permutations
    hn_ex pivot[HN_BLOCK_LU_MOST]; ///< of the last solve: an entry or a determinant for each block
} hn_block_lu;

/// Chooses the order for A (n x n row-major, n up to HN_BLOCK_LU_MOST), whose values at a typical
/// configuration are `value`. Returns false where a pivot vanishes there.
bool hn_block_lu_plan(hn_block_lu *lu, int n, const hn_ex *A, const double *value);
/// The order of the rows as they stand, by pivots of one row: for a positive definite matrix.
void hn_block_lu_plan_in_order(hn_block_lu *lu, int n);
/// Writes x (n x m row-major) of (1) for B (n x m row-major). A and B are spoiled. The product of
/// the pivots times `sign` is det A.
void hn_block_lu_solve(hn_graph *g, hn_block_lu *lu, hn_ex *A, hn_ex *B, int m, hn_ex *x);

#endif
