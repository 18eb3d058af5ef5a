// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REDUCED_JSON_H
#define HN_SESSION_REDUCED_JSON_H
// The equations left on the free motion, as a part of the terms' document.

#include "base/strbuf.h"
#include "session/model/model.h"

/// Puts "reduced" into the object open in `b`, at (t, q, v) in system coordinates:
///   {"exists": true, "equations", "independent": [names], "rates": [names], "chosen_by", "v_r",
///   "Phi", "M_r", "C_r", "g_r", "tau_r",
///    "a_r"}, with "s" and "d_r" where closures move with time, and "speed_gap" where the speeds
///    given do not fit the loops;
///   {"exists": false, "why"} where there are no such coordinates.
HN_MUST_CHECK hn_status hn_reduced_put(hn_strbuf *b, const hn_model *model, hn_arena *arena,
                                       double t, const double *q, const double *v);
#endif
