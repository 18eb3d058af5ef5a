// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PACE_H
#define HN_STUDY_PACE_H
// Decides when a loop of steps checks its limits (time used, request to stop): after each step of a
// mechanism of hundreds of bodies, seldom where a step takes a microsecond. Checks are about one to
// ten milliseconds apart; steps do not depend on them. One pace serves a whole run: if it started
// again at each output, it would never check where outputs are few steps apart.

#include <stdbool.h>

typedef struct hn_pace {
    double last; ///< CPU time of this thread at the last check [s]
    int every;   ///< steps between checks
    int n;       ///< steps since the last check
} hn_pace;

/// Begins now, on the thread that will step.
hn_pace hn_pace_begin(void);
/// Counts one step; returns whether a check is due.
bool hn_pace_is_due(hn_pace *pace);
#endif
