#ifndef HN_DYNAMICS_MODE_H
#define HN_DYNAMICS_MODE_H
// Assembly modes of loops: on which branch each loop is closed.

#include "base/arena.h"
#include "dynamics/compile/system.h"

/// Watches the assembly modes of the loops: of each the sign of -det J_d, with J_d the loop's rows
/// and the coordinates that depend on the others. Independent are the loop's actuated coordinates,
/// then its pinned ones, then the first ones, as many as it has degrees of freedom; the dependent ones are
/// taken in the order of the ring. For a four-bar driven by th1 that is the sign of sin(th3 - th2):
/// open +, crossed -. It passes through 0 where the independent coordinates stop serving (dead
/// point); a change of sign without that is a branch jump.
typedef struct hn_mode_watch hn_mode_watch;
/// Memory from `arena`, the tape owned by the watch. A system without a first loop of that kind
/// gives a watch that says 0. Not thread-safe for one system (see system.h); hn_mode_watch_value()
/// is. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_mode_watch_create(const hn_system *sys, hn_arena *arena,
                                             hn_mode_watch **out);
void hn_mode_watch_free(hn_mode_watch *w); ///< NULL is legal
/// Of the first loop: -det J_d over the product of its column lengths, in [-1, 1]; 0 when
/// undefined. Allocates nothing.
double hn_mode_watch_value(hn_mode_watch *w, double t, const double *q);
/// The same of all loops (joints that close one; of formulas, sets of constraints on the same
/// coordinates): their number, and their values.
int hn_mode_watch_count(const hn_mode_watch *w);
void hn_mode_watch_values(hn_mode_watch *w, double t, const double *q, double *values);

/// The sign alone, once: makes and frees a watch, so for a look now and then; 0 when undefined.
int hn_assembly_mode(const hn_system *sys, double t, const double *q);

/// *out = 1: the first loop is a planar four-bar (two rows, three angles, every axis of the ring in
/// the same sense), so that "open" and "crossed" mean something. Scratch from `arena`. Fails:
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_mode_is_four_bar(const hn_system *sys, hn_arena *arena, int *out);
/// The user coordinates of loop `loop` that depend on the others (room for 6); returns their
/// number. Scratch from `arena`.
HN_MUST_CHECK hn_status hn_mode_dependent(const hn_system *sys, hn_arena *arena, int loop,
                                          int *dependent, int *n);
int hn_mode_sign(double value); ///< +1, -1, or 0 within rounding

#endif
