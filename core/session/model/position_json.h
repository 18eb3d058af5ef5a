// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_POSITION_JSON_H
#define HN_SESSION_POSITION_JSON_H
// Writes how the reduced method computes the configuration from its independent coordinates: a part
// of the report of `inspect`.

#include "base/strbuf.h"
#include "session/model/model.h"

/// Puts "position_analysis" into the object open in `b`, for the coordinates that the reduced
/// method chooses at the start:
///   {"independent": [names], "answers": "dyads: closed form (3 of them)" or "Newton, because ...",
///   "operations"?,
///    "operations_of_a_newton_step", "steps"?: [{"kind", "meets", "unknowns", "rows"}]}
///   {"answers": "none: ..."} without loops, or where no set of independent coordinates exists.
HN_MUST_CHECK hn_status hn_position_put(hn_strbuf *b, const hn_model *model);
#endif
