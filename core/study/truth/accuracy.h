// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ACCURACY_H
#define HN_STUDY_ACCURACY_H
// The accuracy watch: an estimate of how far runs are from the true motion, made while they go on.
//
// A pilot run of the same scene by HN_ACCURACY_METHOD goes beside them; what they differ by from it
// is their error, as long as the pilot's own is smaller. That is estimated too, by a rough run with
// a tolerance 1000 times as large: a HN_ACCURACY_OWN-th of the difference of the two, which grows
// with the time, and exponentially where the motion is chaotic. No estimate is below it, so that a
// run by the pilot's own method, which hardly differs from the pilot, gets that number. Local
// errors of single steps would be cheaper, but they say nothing about the error at the end.
//
// Scales are the largest values at the steps of the pilot, short where the motion is fast.
//
// Cost: at most HN_ACCURACY_SHARE of the operations of the runs watched, and HN_ACCURACY_FREE
// operations (some milliseconds) in any case. If that is not enough the estimate ends, and says
// at which time. One pilot serves all methods of a comparison. The runs themselves are read only:
// their motion is the same to the last bit.

#include "study/truth/errors.h"

#define HN_ACCURACY_METHOD "projection@dop853:rtol=1e-8"
#define HN_ACCURACY_ROUGH "projection@dop853:rtol=1e-5"
/// Tolerances of the two differ by 1000; errors follow them within a factor of 10.
#define HN_ACCURACY_OWN 100.0
#define HN_ACCURACY_FLOOR 1e-7 ///< relative: smaller errors are not told apart
#define HN_ACCURACY_WARN 1e-2  ///< an estimate above it is worth a remark
#define HN_ACCURACY_WRONG 1.0  ///< an estimate of q from it on: off by a radian or a length L
/// Error of the pilot itself, of q, that ends the estimate.
#define HN_ACCURACY_LOST 1e-3
#define HN_ACCURACY_SHARE 0.1 ///< of the operations of the runs
#define HN_ACCURACY_FREE 5e6  ///< operations
enum {
    /// Times of a run at which it is compared, evenly spaced: those of the output of a run that
    /// names none. The forces of a four-bar peak for a hundredth of its period.
    HN_ACCURACY_LOOKS = 200,
    /// For a comparison whose frames lie inside steps: a sample there counts in gap and energy too.
    HN_ACCURACY_LOOKS_INSIDE = 64,
    HN_ACCURACY_NODES = 6000, ///< of the system's graph: compiling two runs takes 50 ms there
};

typedef struct hn_accuracy hn_accuracy;

/// Largest differences of one run so far, not yet divided by scales.
typedef struct hn_accuracy_track {
    double worst[HN_ERROR_COUNT];
    const hn_coordinate *at; ///< the one behind worst[HN_ERROR_Q]; NULL: none
    double t;                ///< last time compared [s]
    int n;                   ///< times compared
} hn_accuracy_track;

typedef struct hn_estimate {
    bool known;
    /// As in errors.h, the largest so far; never below `own`. `reaction` is NaN for a mechanism
    /// without constraint rows.
    double q, v, reaction;
    const hn_coordinate *at; ///< which was off by q; NULL: none
    double off;              ///< q in its unit [rad or m]
    bool unloaded;    ///< reactions are below hn_errors_least_reaction(), and `reaction` is of that
    double own;       ///< of q: error of the pilot itself, at least HN_ACCURACY_FLOOR
    double t;         ///< up to which it holds [s]
    char reason[200]; ///< why it is not known, or ended before the run; else ""
} hn_estimate;

/// Makes the pilot and the rough run from the assembled state (q, v) in system coordinates, for
/// runs to t_end.
/// Not thread-safe for one system (see system.h). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT. A scene that
/// the method refuses, or a very large one, gives a watch that knows nothing and says why.
HN_MUST_CHECK hn_status hn_accuracy_create(const hn_system *sys, const double *q, const double *v,
                                           double t_end, hn_accuracy **out);
void hn_accuracy_free(hn_accuracy *a); ///< NULL is legal
void hn_accuracy_reset(hn_accuracy *a);
/// The time that the pilot and the rough run have reached [s].
double hn_accuracy_time(const hn_accuracy *a);
void hn_accuracy_loads_changed(hn_accuracy *a, double t); ///< see hn_run_loads_changed()
/// Returns whether a comparison is due at t: the times depend on t_end alone, so that a run has the
/// same estimate whoever makes it.
bool hn_accuracy_is_due(const hn_accuracy *a, double t);
/// The time of the next comparison [s], HUGE_VAL: there is none.
double hn_accuracy_next(const hn_accuracy *a);
/// Brings the pilot to t; `ops` are the operations of the runs watched, so far. Returns true when
/// samples of time t can be compared now.
bool hn_accuracy_reach(hn_accuracy *a, double t, double ops);
/// Compares a sample of the time reached last. `track` starts as zeros.
void hn_accuracy_see(hn_accuracy *a, const hn_sample *sample, hn_accuracy_track *track);
/// Compares the last state of a run that ended early, whether or not a comparison is due there: how
/// far a failed run went wrong then does not depend on the time that was asked for. `ops` as in
/// hn_accuracy_reach(). A pilot that has gone past that time, or cannot reach it, compares nothing.
void hn_accuracy_see_end(hn_accuracy *a, hn_run *run, double ops, hn_accuracy_track *track);
/// The estimate of a run whose samples were seen; t_run: time that it has reached.
hn_estimate hn_accuracy_estimate(const hn_accuracy *a, const hn_accuracy_track *track,
                                 double t_run);
/// Operations of pilot and rough run so far.
double hn_accuracy_ops(const hn_accuracy *a);

#endif
