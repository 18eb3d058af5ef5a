// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_STATE_H
#define HN_SESSION_MODEL_STATE_H
// A state given by entries that override the assembled start.

#include "session/model/model.h"

/// Computes q (nq) and v (nv), in system coordinates: the start, with the entries replaced. The
/// other coordinates stay, so the loops may be open.
/// Fails: HN_ERR_INPUT for an unknown name, reported at "/state/NAME" with the nearest known name,
/// and for a value so large that another coordinate loses its digits beside it.
HN_MUST_CHECK hn_status hn_model_state(const hn_model *model, const hn_state_entry *entries,
                                       int n_entries, double *q, double *v, hn_diags *diags);
#endif
