// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_FACTOR_H
#define HN_DYNAMICS_FACTOR_H
// The factor of the saddle-point matrix as numbers, for methods that solve with it more than once:
//
//     K = [W J'; J 0] = L D L',   W = M(q), its diagonal, or the identity                     (1)
//
// A tape gives the entries of L and D^-1; the order and the pattern were fixed when the system was
// compiled, so the cost grows with the entries of L (linearly for a chain of loops). No pivoting:
// every pivot is guarded at run time.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/tape.h"

#include <stdbool.h>

typedef struct hn_factor hn_factor;

/// Diagonal: M_jj, and 1 where that vanishes identically (a massless coordinate keeps its own
/// unit).
typedef enum hn_factor_weight {
    HN_FACTOR_MASS,
    HN_FACTOR_IDENTITY,
    HN_FACTOR_DIAGONAL
} hn_factor_weight;

typedef struct hn_factor_info {
    /// 0: no static order exists for this system; hn_factor_update() always says HN_ERR_SINGULAR
    bool available;
    int n_blocks;   ///< pivots (1 x 1 or 2 x 2)
    int nnz;        ///< entries of L below the diagonal blocks
    int update_ops; ///< arithmetic operations of one update
    int solve_ops;  ///< arithmetic operations of one solve
} hn_factor_info;

/// Memory from `arena`, the tape owned by the factor (hn_factor_free). Fails: HN_ERR_MEMORY,
/// HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_factor_create(const hn_system *sys, hn_factor_weight weight,
                                         hn_arena *arena, hn_factor **out);
void hn_factor_free(hn_factor *f); ///< NULL is legal
hn_factor_info hn_factor_get_info(const hn_factor *f);

/// Factors K at (t, q). *pivot_ratio (may be NULL) as in hn_accel_info. Fails: HN_ERR_SINGULAR when
/// a pivot fell below HN_PIVOT_GUARD times its reference (use the dense solve then),
/// HN_ERR_DIVERGED when q is not finite. Allocates nothing.
HN_MUST_CHECK hn_status hn_factor_update(hn_factor *f, double t, const double *q,
                                         double *pivot_ratio);

/// Returns, for the last update, the shortest row of J over the longest of its loop, in squared
/// lengths (row_groups.h); 1 where there is no static order.
double hn_factor_row_ratio(hn_factor *f);

/// Solves K [x; -y] = [r1; r2] with the last successful factor: x (nv), y (nc); y may be NULL. The
/// right-hand side and the solution may be the same arrays. r1 or r2 may be NULL, which means zero.
/// Allocates nothing.
///   acceleration: r1 = f, r2 = -gamma gives a, lambda
///   projection:   r1 = NULL, r2 = -phi gives dq = x with J dq = -phi and least W-norm
void hn_factor_solve(hn_factor *f, const double *r1, const double *r2, double *x, double *y);

#endif
