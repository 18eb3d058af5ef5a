// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_WALK_H
#define HN_STUDY_WALK_H
// Takes a run to its end, with a callback at equal intervals, within a limit of computing time, and
// stops on request.

#include "study/run/run.h"

typedef struct hn_walk_limits {
    double seconds; ///< CPU time of this thread; 0: none
    /// Asked now and then; 1 stops. NULL: never.
    int (*stop)(void *user);
    void *user;
} hn_walk_limits;

typedef enum hn_walk_end {
    HN_WALK_DONE,
    HN_WALK_FAILED,  ///< the run's summary says why
    HN_WALK_OVER,    ///< out of computing time
    HN_WALK_STOPPED, ///< on request
} hn_walk_end;

/// Gets the sample at t = k T / n, for k = 1 to n. Returns 1 to go on, 0 to end the walk as failed.
typedef int (*hn_walk_see)(void *user, int k, const hn_sample *sample);

/// Takes a run from its start to T and calls `see` at n equal intervals. Fixed steps stay on their
/// own grid. With `see` NULL no sample is taken, as in a run that is timed.
hn_walk_end hn_walk(hn_run *run, double T, int n, const hn_walk_limits *limits, hn_walk_see see,
                    void *user);
/// Checks the limits of a computation that began at `started` (hn_clock_thread()). Returns
/// HN_WALK_DONE while it may go on, else HN_WALK_OVER or HN_WALK_STOPPED.
hn_walk_end hn_walk_ask(const hn_walk_limits *limits, double started);
#endif
