// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_FORMULA_H
#define HN_DYNAMICS_FORMULA_H
// Formulas of a scene in its own names: parameters, t, coordinates and rates as the scene calls
// them.

#include "dynamics/compile/system_impl.h"

/// Writes the expression of a quantity: its number, or its formula in parameters and, where it
/// varies, the state. Fails, with a report: HN_ERR_UNSUPPORTED, or as the parser does.
HN_MUST_CHECK hn_status hn_system_quantity(const hn_system *sys, const hn_quantity *quantity,
                                           hn_ex *out);
/// The same with these expressions in place of the scene's coordinates and their rates (by index).
HN_MUST_CHECK hn_status hn_system_quantity_of(const hn_system *sys, const hn_quantity *quantity,
                                              const hn_ex *positions, const hn_ex *rates,
                                              hn_ex *out);
/// Three quantities at once.
HN_MUST_CHECK hn_status hn_system_vector(const hn_system *sys, const hn_quantity *quantity,
                                         hn_vec3 *out);
/// Makes symbols "kind name" that stand for the scene's coordinates (or their rates) while a
/// formula is differentiated by them.
void hn_system_stand_ins(const hn_system *sys, const char *kind, hn_ex *out, int *symbols);

#endif
