// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_MOTION_INCIDENTS
#define HN_STUDY_MOTION_INCIDENTS
// Measures of the last step that several checks share.

#include "study/incidents/watch.h"

/// Returns how much of the last step's motion its velocities do not explain, over that motion, or
/// `least` where it was less: 0 for smooth motion, about 1 or more for a jump.
double hn_motion_unexplained_between(const hn_watch *w, const hn_state_at *from,
                                     const hn_state_at *to, double least);
/// The same of the last step.
double hn_motion_unexplained(const hn_watch *w, double least);
/// Returns whether that is no more than `share` and the velocities do not turn round. Without a
/// division: it is asked after every step.
bool hn_motion_is_steady(const hn_watch *w, double share);
/// Returns how far the motion from `from` (nq) to now would have opened a loop with one of its
/// coordinates alone, over the length: with J of the state checked in full last. `step` (nv) gets
/// the motion.
double hn_motion_way(const hn_watch *w, const double *from, double *step);
/// Returns the shortest row of J at some state against the largest that row has been.
double hn_motion_shortest_row(const hn_watch *w, const hn_closure_rows *rows);
/// Degrees of freedom at the start.
int hn_motion_dof(const hn_watch *w);
/// Runs a pilot run (dynamics/analyse/pilot.h) from a state to time t, with steps finer than those
/// of the run and short against the motion; at most a few hundred. Returns it, NULL where its
/// equations have no solution on the way. *lowest gets the lowest sigma_min at its steps. Allocates
/// nothing.
const hn_pilot *hn_motion_pilot(hn_watch *w, const hn_state_at *from, double t, double *lowest);
/// Says whether the accelerations lead from one state to the other: a pilot run from the first
/// arrives near the second, against the way between them. Says no where the loops stand open.
bool hn_motion_is_followed(hn_watch *w, const hn_state_at *from, const hn_state_at *to);

#endif
