// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SOLVE_ROWS_H
#define HN_DYNAMICS_SOLVE_ROWS_H
// The rows that the tape of accelerations solves with: the system's own, or those seen from the
// legs of its spatial loops (leg.h), whichever take fewer operations. Both have the same solution.

#include "dynamics/compile/entries.h"
#include "dynamics/compile/system.h"
#include "dynamics/evaluate/ldl.h"

#include <stdbool.h>

typedef struct hn_solve_rows {
    const hn_ldl *ldl;
    hn_entries J;
    const hn_ex *phi, *gamma; ///< nc each
    bool of_legs;
    long work_own, work_legs; ///< either way, by the nodes of the graph; 0: not counted
} hn_solve_rows;

/// Finds the rows of a system, chosen when they are first asked for; borrowed, live as long as the
/// system. Adds nodes to its graph. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_solve_rows_get(const hn_system *sys, const hn_solve_rows **out);
/// Finds what the rows of the legs save: operations of accelerations and multipliers with the
/// system's own rows less those with these, both compiled to be counted; 0 where the own are taken.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_solve_rows_saved(const hn_system *sys, int *ops);
/// Right-hand sides of all unknowns: f, then -(gamma + 2 alpha (J v + phi_t) + beta^2 phi), where
/// `baumgarte` is false -gamma. `rhs` has nv + nc entries.
void hn_solve_rows_rhs(const hn_system *sys, const hn_solve_rows *rows, bool baumgarte, hn_ex *rhs);
/// Turns the negative multipliers (nc) of these rows to those of the system's own.
void hn_solve_rows_turn(const hn_system *sys, const hn_solve_rows *rows, hn_ex *lambda);
#endif
