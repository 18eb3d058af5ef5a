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
/// that were not done yet are forgotten. The point needs a load (hn_model_source.pulls). A
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
/// Back to frame 0. The log of pulls stays, and is done again.
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

/// Writes the present frame: {"frame","t","finished","methods":[{"state","t","points":[...],"gap",
/// "velocity_gap","energy","work","energy_change","steps","evals","ops","cpu","step_cpu":{"median",
/// "low","high","frames"},"worst_gap",...}]}; step_cpu as hn_step_cost
void hn_comparison_frame_json(hn_strbuf *b, const hn_comparison *c);
/// What a frame may say beside: an array with an entry for each method.
typedef enum hn_frame_extra {
    HN_FRAME_SIGMA_MIN, ///< hn_run_sigma_min() at the last step that was checked
    HN_FRAME_LAMBDA,    ///< multipliers of the sample, an array
    HN_FRAME_CONDITION, ///< hn_run_condition() at the last step that was checked
    HN_FRAME_EXTRAS
} hn_frame_extra;
const char *hn_frame_extra_name(hn_frame_extra extra); ///< "sigma_min"
void hn_comparison_extra_json(hn_strbuf *b, const hn_comparison *c, hn_frame_extra extra);
/// Writes the properties of the methods (spelling, short name, colour slot, rule, order), frame_dt
/// and duration.
void hn_comparison_json(hn_strbuf *b, const hn_comparison *c);
/// Writes the final table: status, reason, time reached, largest violations, largest change of
/// energy, steps, rejected steps, evaluations, operations and CPU time per method; then the
/// incidents.
void hn_comparison_summary_json(hn_strbuf *b, const hn_comparison *c);

// one run with output, for `holonom run` and POST /runs ----
typedef struct hn_run_request {
    const char *method;
    double time;      ///< end [s]
    const double *at; ///< output times, ascending; NULL: `every`
    int n_at;
    double every;          ///< 0: 200 samples
    long long max_samples; ///< bound
    long long max_numbers; ///< in the tables of the answer; 0: 2^25
    long long max_steps;
    /// 1: adds a column "raw_lambda" where the integrator computes multipliers of its own
    int raw_lambda;
    /// 1: adds columns "reaction_force", "reaction_moment" (names: "carriers") and "effort" (names:
    /// "efforts")
    int reactions;
    /// called every few milliseconds with the share done; returns 0 to stop. May be NULL.
    int (*progress)(void *user, double share);
    /// Called with each sample when it is made; NULL: not wanted. `values` are t, q, v, lambda,
    /// raw_lambda, lambda_mark, reaction_force, reaction_moment, effort, points, gap, velocity_gap,
    /// energy, work, energy_change, those that the document of the run has. `names` is that
    /// document with this sample alone, at the first call, and NULL at all others. The document at
    /// the end then has "lambda_mark" alone of its samples.
    void (*row)(void *user, const hn_strbuf *names, const double *values, int n);
    void *row_user;
    const char *stop_reason; ///< reason if `progress` stops the run; NULL: "stopped on request"
    void *user;
} hn_run_request;

#endif
