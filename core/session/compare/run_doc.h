// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARE_RUN_DOC_H
#define HN_SESSION_COMPARE_RUN_DOC_H
// One run with its samples: the document of `holonom run --json`.

#include "session/compare/comparison.h"

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
