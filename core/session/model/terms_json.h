// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_TERMS_JSON_H
#define HN_SESSION_MODEL_TERMS_JSON_H
// Every term at one state, in the coordinates of the scene.

#include "session/model/model.h"

/// M, h, f, J, gamma, phi, K, acceleration, lambda, energies at one state, in user coordinates,
/// with ranks and sigma; "rows" and "columns" named. "lambda_mark" says in words what the
/// multipliers are worth, and the reactions that rest on them (hn_multiplier_mark).
HN_MUST_CHECK hn_status hn_model_terms_json(hn_strbuf *b, const hn_model *model, double t,
                                            const hn_state_entry *entries, int n_entries,
                                            hn_diags *diags);
/// The same with "reactions" too: what every joint and constraint carries (reactions_json.h).
HN_MUST_CHECK hn_status hn_model_terms_json_with_reactions(hn_strbuf *b, const hn_model *model,
                                                           double t, const hn_state_entry *entries,
                                                           int n_entries, hn_diags *diags);
#endif
