// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_OWN_STEPS_H
#define HN_SESSION_EXPORT_OWN_STEPS_H
// The steps of the method that an export was asked for: an exported program repeats those of
// explicit Runge-Kutta methods with a fixed step, and compares its loop gap with the workbench's.

#include "integrators/explicit/tableau.h"
#include "integrators/method/method_spec.h"
#include "session/export/places.h"

/// Finds whether the program can take the method's steps: e->steps. If it can, runs the
/// method for the scene's duration, or the first 2000 steps, and keeps the largest gap at the end
/// of a step. Otherwise e->steps.why says why not. After hn_export_states_find().
/// Fails: HN_ERR_MEMORY, HN_ERR_STOPPED (the limits).
HN_MUST_CHECK hn_status hn_export_own_steps_find(hn_exporter *e, const hn_method_spec *spec,
                                                 hn_diags *diags);
/// Adds a row of the tableau as the language writes a list: "0, 0.5, 0".
void hn_export_own_steps_put(hn_strbuf *b, const hn_exporter *e, const char *place);

#endif
