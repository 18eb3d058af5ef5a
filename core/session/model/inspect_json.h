// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_INSPECT_JSON_H
#define HN_SESSION_MODEL_INSPECT_JSON_H
// The report of `inspect`: the compiled equations of a scene and its assembled start.

#include "session/model/model.h"

/// Writes sizes, tree, loops, rank, redundant constraints, operation counts and the position
/// analysis.
HN_MUST_CHECK hn_status hn_model_inspect_json(hn_strbuf *b, const hn_model *model, hn_diags *diags);
#endif
