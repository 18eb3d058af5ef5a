// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_STEP_TRIAL_H
#define HN_TUI_STEP_TRIAL_H
// Whether a method is wrong because its step is too long: the same method with 2, 4, 8 and 16 times
// shorter steps (tolerances 10 to 10^4 times finer), one after the other on a thread of its own,
// until the motion is right to its end.

#include "base/diag.h"
#include "session/model/model.h"

#include <stdbool.h>

typedef struct hn_step_trial hn_step_trial;

/// Result of the trial so far.
typedef enum hn_step_finding {
    HN_STEP_RUNNING, ///< not known yet
    HN_STEP_LONG,    ///< a shorter step would do
    HN_STEP_NO_HELP, ///< none of those tried would, or none could be tried in the time
    HN_STEP_UNKNOWN  ///< nothing can be said: no reference motion
} hn_step_finding;

typedef struct hn_step_report {
    hn_step_finding finding;
    char cause[480]; ///< a sentence for people; "" where nothing can be said
    char remedy[64]; ///< "h=0.0025", the longest step that would do; "": none
    char tried[320]; ///< what it gave: "tried until t = 10 s: right to 2 digits"
} hn_step_report;

static const double HN_STEP_TRIAL_LIMIT = 3; ///< [s] of computing for all steps together

typedef struct hn_step_trial_request {
    const char *spelling; ///< of the method
    double wrong_at;      ///< when it is known to be wrong [s]
    double limit;         ///< of computing for all steps together [s]; 0: the usual one
} hn_step_trial_request;

/// Starts the trial of a method on the scene `source`, to the end of its motion. Returns owned in
/// *out. Fails: as hn_model_load() and hn_recording_create(); HN_ERR_UNSUPPORTED where the method
/// has neither a step nor a tolerance.
HN_MUST_CHECK hn_status hn_step_trial_start(const hn_library *library,
                                            const hn_model_source *source,
                                            const hn_step_trial_request *request,
                                            hn_step_trial **out, hn_diags *diags);
/// Stops the thread, and frees all. NULL is legal.
void hn_step_trial_free(hn_step_trial *s);
/// The method that is tried.
const char *hn_step_trial_spelling(const hn_step_trial *s);
/// Judges what is recorded by now, and goes on with the next step that is to be tried.
void hn_step_trial_judge(hn_step_trial *s, hn_step_report *out);
#endif
