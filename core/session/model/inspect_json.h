// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_INSPECT_JSON_H
#define HN_SESSION_MODEL_INSPECT_JSON_H
// What the compiler made of a scene, and what assembly found at its start.

#include "session/model/model.h"

/// sizes, tree, loops, rank, operations kept and left out
HN_MUST_CHECK hn_status hn_model_inspect_json(hn_strbuf *b, const hn_model *model, hn_diags *diags);
#endif
