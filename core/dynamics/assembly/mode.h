// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_MODE_H
#define HN_DYNAMICS_MODE_H
// Assembly modes of loops: on which branch each loop is closed.

#include "base/arena.h"
#include "dynamics/compile/system.h"

/// Watches the assembly modes of the loops: of each the sign of -det J_d, with J_d the loop's rows
/// and the coordinates that depend on the others. Independent are the loop's actuated coordinates,
/// then its pinned ones, then the first ones, as many as it has degrees of freedom; the dependent
/// ones are taken in the order of the ring. For a four-bar driven by th1 that is the sign of
/// sin(th3 - th2): open +, crossed -. It passes through 0 at a dead point, where the independent
/// coordinates no longer determine the others; a change of sign elsewhere is a branch jump.
typedef struct hn_mode_watch hn_mode_watch;
/// Memory from `arena`, the tape owned by the watch. Without a loop of that kind its values are 0.
/// Creating a watch adds nodes to the graph (system.h on threads). Fails: HN_ERR_MEMORY,
/// HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_mode_watch_create(const hn_system *sys, hn_arena *arena,
                                             hn_mode_watch **out);
void hn_mode_watch_free(hn_mode_watch *w); ///< NULL is legal
/// Returns the mode value of the first loop: -det J_d over the product of its column lengths, in
/// [-1, 1]; 0 when undefined. Allocates nothing.
double hn_mode_watch_value(hn_mode_watch *w, double t, const double *q);
/// The same of all loops (joints that close one; of formulas, sets of constraints on the same
/// coordinates): their number, and their values.
int hn_mode_watch_count(const hn_mode_watch *w);
void hn_mode_watch_values(hn_mode_watch *w, double t, const double *q, double *values);

/// *out = 1 if the first loop is a planar four-bar (two rows, three angles, every axis of the ring
/// in the same sense), whose modes are called "open" and "crossed". Scratch from `arena`.
/// Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_mode_is_four_bar(const hn_system *sys, hn_arena *arena, int *out);
/// Writes the user coordinates of loop `loop` that depend on the others (room for 6) and their
/// number n. Scratch from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_mode_dependent(const hn_system *sys, hn_arena *arena, int loop,
                                          int *dependent, int *n);
int hn_mode_sign(double value); ///< +1, -1, or 0 within rounding

#endif
