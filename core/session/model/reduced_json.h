// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REDUCED_JSON_H
#define HN_SESSION_REDUCED_JSON_H
// The equations of motion reduced to independent coordinates, as a part of the terms' document.

#include "base/strbuf.h"
#include "session/model/model.h"

/// Writes "reduced" into the open object, at (t, q, v) in system coordinates:
///   {"exists": true, "equations", "independent": [names], "rates": [names], "chosen_by", "v_r",
///    "Phi", "M_r", "C_r", "g_r", "tau_r", "a_r"}, with "s" and "d_r" where constraints depend on
///    time, and "speed_gap" where v violates the constraints;
///   {"exists": false, "why"} where no set of independent coordinates exists.
HN_MUST_CHECK hn_status hn_reduced_put(hn_strbuf *b, const hn_model *model, hn_arena *arena,
                                       double t, const double *q, const double *v);
#endif
