// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PRECISE_SOLVER_H
#define HN_STUDY_PRECISE_SOLVER_H
// Accelerations in extended precision, in two ways that share nothing but the model's terms: a
// table each.

#include "study/truth/precise_model.h"

typedef struct hn_precise_solver {
    const char *name; ///< first half of a computation's name
    HN_MUST_CHECK hn_status (*create)(hn_precise_model *m, hn_arena *arena, void **ws);
    /// Chooses the rows of J that count at this configuration; called first, and at the start of
    /// each step.
    void (*choose_rows)(void *ws, hn_real t, const hn_real *q);
    /// a (nv) and lambda (nc, NULL: not wanted) at a state. Fails: HN_ERR_SINGULAR.
    HN_MUST_CHECK hn_status (*accelerate)(void *ws, hn_real t, const hn_real *q, const hn_real *v,
                                          hn_real *a, hn_real *lambda);
    /// q and v in place, closed to rounding; left alone where J is about to lose rank, as a
    /// correction would carry them away. Fails: HN_ERR_SINGULAR, HN_ERR_NO_CONVERGENCE.
    HN_MUST_CHECK hn_status (*close)(void *ws, hn_real t, hn_real *q, hn_real *v);
} hn_precise_solver;

/// K [a; -lambda] = [f; -gamma] whole, by elimination with pivots of the largest relative size;
/// corrections of least kinetic energy.
extern const hn_precise_solver hn_precise_saddle;
/// a = N z + c by an orthogonal basis N of the null space of J, made anew at each state;
/// corrections of least length.
extern const hn_precise_solver hn_precise_nullspace;
#endif
