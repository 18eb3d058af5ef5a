// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LEG_H
#define HN_DYNAMICS_LEG_H
// The position rows of a spatial loop a second time, along the axes of the last body of one end:
// the loop's leg. With V the turn from the leg's axes to the frame of the closure (relate.h),
//
//     phi' = V' phi,   J' = V' J,   gamma' = V' gamma,   lambda = V lambda'
//
// are the same equations at every state, so the solution is the same too. Seen from the leg its own
// coordinates move the point along its axes: J' has few entries there and the elimination little to
// fill (ldl.h). The motion of the other end is written in the axes of its first joint, which legs
// of one platform share, and turned as a whole.

#include "dynamics/compile/closure.h"

/// Traces the leg of a closure whose three position rows are the system's from `first_row` on, and
/// adds it to the system's legs. Nothing is added for a loop that turns about parallel axes only,
/// or whose ends have the absolute angle of their common ancestor.
HN_MUST_CHECK hn_status hn_leg_trace(const hn_closure *c, int first_row);
/// Counts for each link how many closures pass it, into m->passed.
void hn_leg_count_passes(hn_mech *m);

#endif
