// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_EVAL_H
#define HN_DYNAMICS_EVAL_H
// Evaluators: one tape for exactly the terms asked for.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/tape.h"

typedef enum hn_term {
    HN_TERM_M = 1 << 0,      ///< nv x nv row-major
    HN_TERM_F = 1 << 1,      ///< nv: Q - h
    HN_TERM_PHI = 1 << 2,    ///< nc
    HN_TERM_PHI_T = 1 << 3,  ///< nc
    HN_TERM_J = 1 << 4,      ///< nc x nv row-major
    HN_TERM_GAMMA = 1 << 5,  ///< nc
    HN_TERM_ENERGY = 1 << 6, ///< 2: kinetic, potential [J]
    HN_TERM_POINTS = 1 << 7, ///< 3 n_points [m]
    HN_TERM_RATES = 1 << 8   ///< nc: J v + phi_t
} hn_term;
enum { HN_TERM_COUNT = 9 };

typedef struct hn_eval hn_eval;

/// Creates an evaluator of the terms in the mask. Memory from `arena`, the tape owned by the
/// evaluator (hn_eval_free). Adds nodes to the system's graph. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_eval_create(const hn_system *sys, unsigned terms, hn_arena *arena,
                                       hn_eval **out);
/// The same with M and J by their entries alone: for large scenes, where dense arrays would take
/// more memory and time than everything else.
HN_MUST_CHECK hn_status hn_eval_create_listed(const hn_system *sys, unsigned terms, hn_arena *arena,
                                              hn_eval **out);
void hn_eval_free(hn_eval *e); ///< frees the tape; NULL is legal
/// Evaluates all its terms; allocates nothing. v may be NULL: zero.
void hn_eval_run(hn_eval *e, double t, const double *q, const double *v);
/// The values of one term as last evaluated (borrowed, the same place for life). Of M and J,
/// entries that are identically zero are set once; a run writes the others. Not for M and J of an
/// evaluator that lists them.
const double *hn_eval_get(const hn_eval *e, hn_term term);
/// M or J of an evaluator that lists them: the values of the entries of hn_eval_pattern().
const double *hn_eval_list(const hn_eval *e, hn_term term);
/// Writes them to their places in a dense array, whose other entries are left alone; of M to both
/// triangles.
void hn_eval_spread(const hn_eval *e, hn_term term, double *dense);
/// The entries of a term that are not identically zero: returns their number, and their rows and
/// columns (borrowed). The lower triangle of M; column 0 of vectors. For large scenes, where a
/// walk through dense arrays would cost more than the evaluation.
int hn_eval_pattern(const hn_eval *e, hn_term term, const int **rows, const int **cols);
hn_tape_info hn_eval_info(const hn_eval *e);
long long hn_eval_count(const hn_eval *e); ///< runs so far

#endif
