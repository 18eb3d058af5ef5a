// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CROSSING_INCIDENTS
#define HN_STUDY_CROSSING_INCIDENTS
// Finds singular configurations inside a long step, where neither of its ends is near one. Between
// the ends the motion is taken as the cubic through both states.

#include "study/incidents/watch.h"

/// Reports a singular configuration inside the last step. Comes before the singularity monitor sees
/// the end of the step.
void hn_crossing_check(hn_watch *w);

#endif
