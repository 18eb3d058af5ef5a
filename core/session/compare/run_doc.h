// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARE_RUN_DOC_H
#define HN_SESSION_COMPARE_RUN_DOC_H
// One run with its output: the object of `holonom run --json`.

#include "session/compare/comparison.h"

/// The object of `run --json`: scene, method, status, reason, t_reached, coordinates, samples as
/// columns, incidents, cost. The column "lambda_mark" says what a sample's multipliers are worth,
/// and the reactions that rest on them: an index into "lambda_marks" (hn_multiplier_mark); it is
/// left out of a scene without closure rows. *status says how the run ended (HN_OK or why it ended
/// early). Returns not HN_OK only when the request itself is at fault.
HN_MUST_CHECK hn_status hn_model_run_json(hn_strbuf *b, const hn_model *model,
                                          const hn_run_request *request, hn_status *ended,
                                          hn_diags *diags);
#endif
