// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_STATE_H
#define HN_SESSION_MODEL_STATE_H
// See model.h.

#include "session/model/model.h"

/// q (nq), v (nv) in system coordinates: the start with the entries put in their places; nothing
/// else moves, so the loops may open. Unknown names are told with the nearest one (pointer
/// "/state/NAME").
HN_MUST_CHECK hn_status hn_model_state(const hn_model *model, const hn_state_entry *entries,
                                       int n_entries, double *q, double *v, hn_diags *diags);
#endif
