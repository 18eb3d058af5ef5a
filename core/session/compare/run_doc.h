// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARE_RUN_DOC_H
#define HN_SESSION_COMPARE_RUN_DOC_H
// One run with its samples: the document of `holonom run --json`.

#include "base/diag.h"
#include "base/strbuf.h"
#include "session/model/model.h"

#include <stdbool.h>

/// A run with output, for `holonom run` and POST /runs.
typedef struct hn_run_request {
    const char *method;
    double time;      ///< end [s]
    const double *at; ///< output times, ascending; NULL: `every`
    int n_at;
    double every;          ///< 0: 200 samples
    long long max_samples; ///< bound
    long long max_numbers; ///< in the tables of the answer; 0: 2^25
    long long max_steps;
    /// no time limit stops it: fixed steps that are more than max_steps end it before the first
    bool to_the_end;
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

/// Runs the request and writes scene, method, status, reason, t_reached, coordinates, samples as
/// columns, incidents and cost. The column "lambda_mark" is an index into "lambda_marks"
/// (hn_multiplier_mark): it says whether the multipliers of a sample, and the reactions computed
/// from them, are unique. A scene without constraints has no such column.
/// *ended is the status of the run (HN_OK, or why it ended early). The function itself fails only
/// when the request is wrong or memory runs out.
HN_MUST_CHECK hn_status hn_model_run_json(hn_strbuf *b, const hn_model *model,
                                          const hn_run_request *request, hn_status *ended,
                                          hn_diags *diags);
#endif
