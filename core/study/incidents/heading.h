// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_HEADING_INCIDENTS
#define HN_STUDY_HEADING_INCIDENTS
// The direction of motion. With one degree of freedom it is a matter of the configuration alone,
// and smooth on a branch: a run that leaves its smooth continuation has changed the branch.

#include "study/incidents/watch.h"

/// Prepares the watch's part for the direction; in the arena of the run. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_heading_create(hn_watch *w);
/// Takes the present direction as the first one.
void hn_heading_start(hn_watch *w);
/// Compares the direction of motion with its smooth continuation, past a singular configuration or
/// where the step looks like a jump. Returns the angle between the two [rad] where they were
/// compared, else a negative number; HUGE_VAL where the steps are too long for it. If the angle
/// is to be reported, w->heading.explained says whether the motion itself turns there: a pilot run
/// from the last direction that was taken arrives at the present one.
double hn_heading_check(hn_watch *w);
/// Says whether the run moves on while J stays all but rank deficient: *way gets how far it has
/// gone, over the length.
bool hn_heading_stays_singular(hn_watch *w, double *way);

#endif
