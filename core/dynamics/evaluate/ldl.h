// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LDL_H
#define HN_DYNAMICS_LDL_H
// Sparse symbolic factorisation K = L D L' of the saddle-point matrix [W J'; J 0], written as
// expressions; the order of elimination is chosen on the way. Unknowns: 0 .. nv-1 accelerations,
// nv .. nv+nc-1 multipliers (negative).
//
// Order: minimum degree under the rule that a multiplier is never eliminated before every massive
// coordinate it touches (its pivot, zero at first, is then minus a sum of squares), except those
// that the legs of a platform share where its own leg gives it a pivot, and a massless coordinate
// only once a multiplier gave it a pivot. Pivots are 1 x 1, or two multipliers of the same pattern
// taken together as 2 x 2.
//
// No pivoting by size happens at run time, so every pivot comes with a reference: a coordinate's
// own entry of W; for a multiplier the sum that the coordinates alone contribute, shared ones
// included. A pivot small against its reference is lost digits.

#include "base/arena.h"
#include "dynamics/compile/entries.h"

#include <stdbool.h>

typedef struct hn_ldl {
    bool available; ///< false: no static order without a zero pivot, or too dense to be unrolled
    int n, nv, nc;
    int n_blocks;
    int *unknown;     ///< n: unknowns in order of elimination
    int *block;       ///< n_blocks + 1: first position of each block
    int *column;      ///< n_blocks + 1: where the rows of its L start
    int *row;         ///< unknowns with an entry in that column
    hn_ex (*L)[2];    ///< per row entry: against the first and second unknown of the block
    hn_ex (*Dinv)[3]; ///< per block: inverse entries 11, 12, 22 (1 x 1: the first)
    int nnz;          ///< entries of L below the diagonal blocks
    int n_guards;
    /// nc: the sum that the coordinates alone contributed to a multiplier's pivot, its row's length
    /// squared
    hn_ex *row_ref;
    hn_ex (*guard)[2]; ///< pivot, reference; constant ones were checked here and left out
} hn_ldl;

typedef struct hn_ldl_input {
    int nv, nc;
    const hn_entries *W; ///< lower triangle with diagonal; NULL: the identity
    const hn_entries *J; ///< sorted by row, then column
    int pairs;           ///< take multipliers in pairs
} hn_ldl_input;

/// Arrays from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ldl_build(hn_graph *g, const hn_ldl_input *in, hn_arena *arena,
                                     hn_ldl *out);

/// Whether the solves of eval.h and factor.h pair multipliers. Measured on one machine (gcc 12,
/// -O2), singles against pairs: FB0 124 operations and 71 instructions against 128 and 74, 3 % less
/// time; the ladder of 200 loops 179.7 operations a loop against 175.7, 4 % more time, within what
/// runs scatter. The small mechanism decides.
enum { HN_ACCEL_PAIRS = 0 };

/// x with K x = rhs, as expressions (n each, in unknown order; may be the same array).
HN_MUST_CHECK hn_status hn_ldl_solve(hn_graph *g, const hn_ldl *ldl, const hn_ex *rhs, hn_ex *x);
#endif
