// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_H
#define HN_SESSION_EXTREME_H
// The extreme matrix: cases in which a method is known to fail, or must not fail. Each case is a
// data file with the prediction of theory and its source. The quantities that can be measured are
// tables in the program; predictions are in the files alone.
//
// A case holds trials. A trial runs a scene by some methods (or hands its saddle system to some
// solvers) for every value of one swept name, takes one quantity from each run, reduces the
// quantities of a sweep to one number (measure), and compares the numbers of all methods with what
// is predicted.
//
//     pass   every number lies in the band, or every outcome is the word
//     warn   outside, by no more than three times the tolerance (a one-sided bound: a factor of
//     ten); or the word for some only
//     fail   anything else

#include "base/arena.h"
#include "base/diag.h"
#include "base/strbuf.h"
#include "session/extreme/extreme_case.h"
#include "session/job/job_request.h"
#include "session/model/library.h"
#include "session/store/journal.h"

#include <stdbool.h>

enum { HN_EXTREME_CASES = 64 };

typedef struct hn_extreme {
    hn_arena *arena;
    const hn_library *lib;
    int n_cases;
    hn_extreme_case cases[HN_EXTREME_CASES];
    uint64_t hash; ///< of the files
    hn_journal journal;
    int resumed; ///< trials that were done before
    int stopped, out_of_time;
} hn_extreme;

/// Runs all trials that are not done. Trials that were stopped or left out by the time limit stay
/// "not run"; the limit also ends the trial that is running. `run_long`: also runs the trials that
/// take minutes.
void hn_extreme_run(hn_extreme *x, const hn_job_limits *limits, bool run_long);
int hn_extreme_count(const hn_extreme *x, hn_extreme_verdict verdict); ///< trials

#endif
