// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LINEARISE_H
#define HN_DYNAMICS_LINEARISE_H
// Exact derivatives of the equations of motion, for Newton's method in implicit integrators and for
// spectra.
//
//     R(t, q, v, a, lambda) = M(q) a - f(q, v, t) - J(q)' lambda                               (1)
//     dR = K dq + C dv + M da - J' dlambda,   dphi = J dq,   d(J v + phi_t) = V dq + J dv      (2)
//
// dq is a displacement along the velocities (nv entries, hn_system_move): K = R_q G, V = (J v +
// phi_t)_q G. One tape, everything in it shared with M, f and J.

#include "base/arena.h"
#include "dynamics/compile/system.h"

#include <stdbool.h>

typedef enum hn_linear_term {
    HN_LINEAR_RESIDUAL = 1 << 0,  ///< nv: R
    HN_LINEAR_M = 1 << 1,         ///< nv x nv
    HN_LINEAR_K = 1 << 2,         ///< nv x nv, not symmetric in general
    HN_LINEAR_C = 1 << 3,         ///< nv x nv: -f_v
    HN_LINEAR_J = 1 << 4,         ///< nc x nv
    HN_LINEAR_V = 1 << 5,         ///< nc x nv
    HN_LINEAR_PHI = 1 << 6,       ///< nc
    HN_LINEAR_SPEED_GAP = 1 << 7, ///< nc: J v + phi_t
    HN_LINEAR_GAMMA_Q = 1 << 8,   ///< nc x nv: gamma_q G
    HN_LINEAR_GAMMA_V = 1 << 9,   ///< nc x nv
    HN_LINEAR_F = 1 << 10,        ///< nv
    HN_LINEAR_GAMMA = 1 << 11     ///< nc
} hn_linear_term;
enum { HN_LINEAR_COUNT = 12 };

typedef struct hn_linear hn_linear;
/// Memory from `arena`, the tape owned by it (hn_linear_free). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_linear_create(const hn_system *sys, unsigned terms, hn_arena *arena,
                                         hn_linear **out);
/// The same with matrices as lists of the entries that are not identically zero: in a large
/// mechanism few of them are, and one of each row would be fetched from a page of its own.
HN_MUST_CHECK hn_status hn_linear_create_listed(const hn_system *sys, unsigned terms,
                                                hn_arena *arena, hn_linear **out);
/// Turns lists into whole matrices, as those of hn_linear_create() are. Fails: HN_ERR_MEMORY; each
/// matrix is then of one kind or the other.
HN_MUST_CHECK hn_status hn_linear_spread(hn_linear *l, hn_arena *arena);
void hn_linear_free(hn_linear *l); ///< NULL is legal
/// a (nv) and lambda (nc) may be NULL: zero. Allocates nothing.
void hn_linear_run(hn_linear *l, double t, const double *q, const double *v, const double *a,
                   const double *lambda);
/// The values of a term as last evaluated: a vector, or a whole matrix row by row.
const double *hn_linear_get(const hn_linear *l, hn_linear_term term);
/// Those of a matrix that is a list, in the order of hn_linear_pattern().
const double *hn_linear_list(const hn_linear *l, hn_linear_term term);
/// Entries of a matrix term that are not identically zero: their number, rows and columns
/// (borrowed).
int hn_linear_pattern(const hn_linear *l, hn_linear_term term, const int **rows, const int **cols);
/// Writes the entries of a matrix of either kind to their places in `whole`, row by row; the other
/// places stay as they are.
void hn_linear_copy_whole(const hn_linear *l, hn_linear_term term, double *whole);
/// Entry k of hn_linear_pattern() of a matrix of either kind.
double hn_linear_entry(const hn_linear *l, hn_linear_term term, int k);
int hn_linear_entries(const hn_linear *l, hn_linear_term term); ///< their number alone
/// out = X x, or X' x, for a matrix term as last evaluated; out and x must not overlap. Costs two
/// operations an entry.
void hn_linear_apply(const hn_linear *l, hn_linear_term term, const double *x, double *out);
void hn_linear_apply_transposed(const hn_linear *l, hn_linear_term term, const double *x,
                                double *out);
/// Returns whether all entries of a term as last evaluated are finite.
bool hn_linear_is_finite(const hn_linear *l, hn_linear_term term);
double hn_linear_ops(const hn_linear *l); ///< arithmetic operations of one run
long long hn_linear_count(const hn_linear *l);
#endif
