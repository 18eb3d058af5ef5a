// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_INSPECT_H
#define HN_DYNAMICS_INSPECT_H
// A compiled scene as a JSON document: tree, loops and why they were cut, frames, coordinates,
// sparsity, exact operation counts of every term and of a whole solve, and everything that was left
// out. Facts only, no estimates.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

/// Writes these keys into the JSON object that is open in `b`:
///   "kind"         "bodies and joints", "Lagrangian" or "bodies, joints and formulas"
///   "sizes"        {"bodies", "speeds", "rows", "loops", "freedoms_by_count" (speeds - rows,
///                  whether rows are redundant or not)}
///   "tree"         lines of text, indented by depth                     (bodies and joints only)
///   "loops"        [{"name", "joint", "why", "rows": [names]}]
///   "groups"       [{"base", "base_rotates", "bodies"}]                 (bodies and joints only)
///   "coordinates"  [{"name", "rate", "meaning", "scene"}]: the system's own, and the scene's
///                  coordinate in terms of them
///   "limits"       [{"name", "min", "max"}]: scene coordinates with limits, a side without one
///                  left out. A limit exerts no force; passing it is reported.
///   "solver"       {"answers", "why", "behind_it"?, "pivots"?, "newton", "newton_size",
///                  "newton_entries"}: the solver of the accelerations, by structure, and that of
///                  the Newton matrices of implicit methods, their size and number of entries (with
///                  ggl, twice the unknowns)
///   "nonzeros"     {"M", "M_of", "J", "J_of", "L", "fill_in"}: entries not identically zero, of
///                  how many; L of the solve
///   "operations"   {"M", "f", "phi", "J", "gamma", "together", "solve", "solve_baumgarte"}: of one
///                  evaluation each
///   "tape"         {"instructions", "slots", "additions", "products", "divisions", "sincos"} of
///                  the solve without Baumgarte
///   "graph_nodes"  of the whole system with these tapes
///   "left_out"     [{"what", "count"?, "operations"?}]
/// Compiles tapes, so it takes as long as a compilation (system.h says who may do that when).
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT; the object is then incomplete.
HN_MUST_CHECK hn_status hn_system_inspect_put(hn_strbuf *b, const hn_system *sys);
/// Writes "actuation" {"actuated", "freedoms", "reading"} likewise: motors against the degrees of
/// freedom that assembly found.
void hn_system_actuation_put(hn_strbuf *b, const hn_system *sys, int freedoms);
#endif
