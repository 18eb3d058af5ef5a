// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARISON_H
#define HN_SESSION_COMPARISON_H
// A comparison: several methods on one scene and one clock. Frame k holds every method's state at t
// = k * frame_dt. A method that fails stays in the comparison with its last good state, its status
// and the reason.

#include "base/diag.h"
#include "base/strbuf.h"
#include "session/compare/hand.h"
#include "session/model/model.h"
#include "study/run/run.h"
#include "study/truth/accuracy.h"

#include <stdbool.h>

enum { HN_COMPARISON_MAX_METHODS = 8 };

typedef struct hn_comparison hn_comparison;

typedef struct hn_comparison_opts {
    /// [s]; 0: chosen as a multiple of the largest fixed step, at least 1/60 s or 1/240 of the
    /// duration, whichever is less
    double frame_dt;
    double duration; ///< [s]; 0: the scene's
    /// computing time [s] allowed to one method for one frame; beyond it the method is stopped with
    /// HN_ERR_STOPPED; 0: 5 s
    double cpu_limit;
    long long max_steps; ///< per method
} hn_comparison_opts;
hn_comparison_opts hn_comparison_opts_default(void);

/// Creates a comparison at its frame 0. The model must outlive it. A wrong spelling, or a method
/// that does not support the scene, is reported in diags (pointer "/methods/2").
HN_MUST_CHECK hn_status hn_comparison_create(const hn_model *model, const char *const *methods,
                                             int n_methods, const hn_comparison_opts *opts,
                                             hn_comparison **out, hn_diags *diags);
void hn_comparison_free(hn_comparison *c);
int hn_comparison_n_methods(const hn_comparison *c);
double hn_comparison_frame_dt(const hn_comparison *c);
double hn_comparison_duration(const hn_comparison *c);
long long
hn_comparison_frame(const hn_comparison *c); ///< index of the present frame, 0 at the start
bool hn_comparison_finished(
    const hn_comparison *c); ///< the clock reached the duration, or every method failed
/// Lets the hand hold a point from the present frame on, or let go (stiffness and damping 0). All
/// methods feel it from the same time on: that of the frame, or the latest time beyond it that a
/// method has stepped to. Stiffness and damping below 0 are chosen, and written to *pull. Events
/// of the log that lie ahead of the present frame, as after a reset, are forgotten.
/// The point needs a load (hn_model_source.pulls). A
/// comparison that does the same events at the same frames by the same methods gives the same bits.
/// Fails as hn_hand_add() does.
HN_MUST_CHECK hn_status hn_comparison_pull(hn_comparison *c, hn_pull *pull, hn_diag *diag);
/// Gives a comparison at frame 0 the events that it will do. Fails as hn_comparison_pull() does.
HN_MUST_CHECK hn_status hn_comparison_set_pulls(hn_comparison *c, const hn_pull_event *events,
                                                int n, hn_diag *diag);
int hn_comparison_pulls(const hn_comparison *c, const hn_pull_event **out); ///< count; borrowed
/// Advances every method to the next frame. The failure of one method is not an error of the
/// comparison.
void hn_comparison_next(hn_comparison *c);
/// Advances in pieces. Returns whether the next frame is complete; false when `stop` (called every
/// few milliseconds; may be NULL) returned 1. The next call continues the frame; until it is
/// complete there are no samples. hn_comparison_reset() discards an unfinished frame.
bool hn_comparison_work(hn_comparison *c, int (*stop)(void *user), void *user);
/// Back to frame 0. The log of pulls stays, and its events are done again at their frames, unless
/// hn_comparison_pull() comes before them.
void hn_comparison_reset(hn_comparison *c);
/// Changes an option, such as "alpha", of one method while it runs; method -1: of all that have it.
HN_MUST_CHECK hn_status hn_comparison_set(hn_comparison *c, int method, const char *key,
                                          double value, hn_diag *diag);
const hn_run *hn_comparison_run(const hn_comparison *c, int method);
int hn_comparison_slot(const hn_comparison *c, int method); ///< colour and dash, see render/look.h
/// Computing time of one step of a method, measured over its last frames, with the methods taking
/// turns.
typedef struct hn_step_cost {
    int frames;               ///< frames measured; too few below HN_STEP_COST_FRAMES
    double median, low, high; ///< [s], quartiles; NaN: too few frames
} hn_step_cost;
enum { HN_STEP_COST_FRAMES = 5 };
hn_step_cost hn_comparison_step_cost(const hn_comparison *c, int method);
/// Gives the sample of a method at the present frame. Returns false when the method has failed;
/// *out is then its last good state.
bool hn_comparison_sample(const hn_comparison *c, int method, hn_sample *out);

// Further access for writers of documents (session/compare/comparison_doc.h).
const hn_model *hn_comparison_model(const hn_comparison *c);           ///< borrowed
const char *hn_comparison_warning(const hn_comparison *c, int method); ///< of the spelling, or ""
bool hn_comparison_is_live(const hn_comparison *c, int method); ///< neither failed nor stopped
double hn_comparison_cpu_limit(const hn_comparison *c);         ///< [s] of one frame
/// Computing time over simulated time in the frame that took too long; 0 where none did.
double hn_comparison_slowness(const hn_comparison *c, int method);
/// Returns the method that has computed for longest in the frame in progress, -1 where none has or
/// no frame is, and in *slowness its computing time over simulated time in this frame so far [-].
int hn_comparison_slowest(const hn_comparison *c, double *slowness);
const hn_hand *hn_comparison_hand(const hn_comparison *c); ///< borrowed
/// Returns the accuracy watch, borrowed, and in *track what it has seen of the method.
const hn_accuracy *hn_comparison_accuracy(const hn_comparison *c, const hn_accuracy_track **track,
                                          int method);

#endif
