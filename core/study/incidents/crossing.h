// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CROSSING_INCIDENTS
#define HN_STUDY_CROSSING_INCIDENTS
// Singular configurations that a long step has gone across: neither of its ends is near them.
// Between the ends the motion is a cubic through both states, in the coordinates that move the
// first to the second.

#include "study/incidents/watch.h"

/// Reports a singular configuration inside the last step. Comes before the singularity monitor sees
/// the end of the step.
void hn_crossing_check(hn_watch *w);

#endif
