// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_QUESTION_H
#define HN_HTTP_RUN_QUESTION_H
// The request of a run in one spelling: equal requests have the same text, and the same id.

#include "base/diag.h"
#include "http/request/scene_request.h"
#include "session/compare/comparison.h"

enum { HN_RUN_ID = 23 };

typedef struct hn_run_question {
    hn_scene_request scene;
    int n_methods, n_at;
    char methods[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX]; ///< in their normal form
    double time, every;                                   ///< [s]
    double *at;                                           ///< [s]; NULL: `every`
    int reactions, raw_lambda;
    struct hn_runs *store; ///< that computes it
    char id[HN_RUN_ID];    ///< hash of the question, the scene and the build, in letters of URLs
} hn_run_question;

/// Reads the body of a request that was checked against the fields of its route, and names it.
/// Start from a zeroed question; hn_run_question_reset() afterwards in any case.
/// Fails: HN_ERR_INPUT (no method, a spelling that is none), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_run_question_read(hn_run_question *q, const cJSON *body,
                                             const hn_library *lib, hn_diags *diags);
void hn_run_question_reset(hn_run_question *q);
/// Writes the question as the body of a request: {"scene","parameters","methods","time",...}.
void hn_run_question_json(hn_strbuf *b, const hn_run_question *q);
#endif
