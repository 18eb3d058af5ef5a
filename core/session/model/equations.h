// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_EQUATIONS_H
#define HN_SESSION_MODEL_EQUATIONS_H
// The equations of motion, with parameters as symbols.

#include "session/model/model.h"

/// The equations of motion with parameters as symbols.
HN_MUST_CHECK hn_status hn_model_equations(hn_strbuf *b, const hn_model *model,
                                           hn_equation_form form, hn_diags *diags);
#endif
