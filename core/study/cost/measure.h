// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_MEASURE_H
#define HN_STUDY_MEASURE_H
// Runs the points of a work-precision study and takes their times.
//
// First every method's coarsest point, then the next finer ones, so that a time limit that runs out
// has served all alike. Then time: samples are taken in rounds over all points (ABAB, not AABB),
// each a batch of runs that lasts 20 ms or more, so that what disturbs the machine for a while
// disturbs all alike. A sample whose wall time exceeds its CPU time by 5 % is taken again. Halfway
// all runs are made anew: the first half of the samples and the second are two measurements, apart
// in time and in memory, and what they disagree on is not ranked (pareto.h). A point that fails, or
// that the time limit leaves out, stays with its reason.

#include "study/cost/workprecision.h"

#include <stdbool.h>

/// Called as things happen; each may be NULL.
typedef struct hn_wp_hooks {
    void *user;
    int (*stop)(void *user);                    ///< 1: stop now; what is done is kept
    void (*progress)(void *user, double share); ///< of the whole study
    void (*point)(void *user, int m, int k);    ///< a point is done or failed
    /// a sample of time was added to a point; m = -1: to the yardstick
    void (*sample)(void *user, int m, int k);
} hn_wp_hooks;

/// Before the first point the states between those of the reference are found; where the time limit
/// does not let that come to its end, all points are left out.
///
/// Runs the pending points; those that are done, failed or timed already (as read from a file) are
/// left as they are. Returns true when nothing is left, false when stopped, out of time, or out
/// of memory (wp->status). Each
/// call has the whole of opts.time_limit.
bool hn_wp_run(hn_wp *wp, const hn_wp_hooks *hooks);

#endif
