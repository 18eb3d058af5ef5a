// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PACE_H
#define HN_STUDY_PACE_H
// When a loop of steps should look at its limits (time used, told to stop): after each step of a
// mechanism of hundreds of bodies, seldom where a step takes a microsecond. Looks are about a
// millisecond to ten apart; steps do not depend on them. One pace serves a whole run: begun anew
// for each output it would never look where outputs are few steps apart.

typedef struct hn_pace {
    double last; ///< CPU time of this thread at the last look [s]
    int every;   ///< steps between looks
    int n;       ///< steps since the last one
} hn_pace;

/// Begins now, on the thread that will step.
hn_pace hn_pace_begin(void);
/// Counts one step; 1 when it is time to look.
int hn_pace_is_due(hn_pace *pace);
#endif
