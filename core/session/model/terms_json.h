// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_TERMS_JSON_H
#define HN_SESSION_MODEL_TERMS_JSON_H
// The terms of the equations of motion at one state, in the coordinates of the scene.

#include "session/model/model.h"

/// Writes M, f, J, gamma, phi and, for small systems, K; the accelerations and multipliers with
/// rank and condition; the reduced equations; constraint violations and energies. "lambda_mark"
/// says whether the multipliers, and the reactions computed from them, are unique
/// (hn_multiplier_mark).
HN_MUST_CHECK hn_status hn_model_terms_json(hn_strbuf *b, const hn_model *model, double t,
                                            const hn_state_entry *entries, int n_entries,
                                            hn_diags *diags);
/// Writes the same document with "reactions" and "efforts" (reactions_json.h).
HN_MUST_CHECK hn_status hn_model_terms_json_with_reactions(hn_strbuf *b, const hn_model *model,
                                                           double t, const hn_state_entry *entries,
                                                           int n_entries, hn_diags *diags);
#endif
