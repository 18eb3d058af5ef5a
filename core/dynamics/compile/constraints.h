// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_CONSTRAINTS_H
#define HN_DYNAMICS_CONSTRAINTS_H
// Constraints beside the joints (distances, lines, planes, gears, rolling, formulas) as rows; the
// derivation is in constraints.c.

#include "dynamics/compile/mech.h"

#include <stdbool.h>

/// Returns whether the constraint acts between two points (gears and formulas act on coordinates).
bool hn_constraint_has_points(const hn_constraint *k);
/// Names the loops of constraints, which follow those of the cut joints.
void hn_constraints_name_loops(hn_system *sys);
/// Adds the rows of every constraint.
HN_MUST_CHECK hn_status hn_mech_trace_constraints(hn_mech *m);
/// Computes the place in the world where point p of a constraint with points lies when the
/// constraint holds.
HN_MUST_CHECK hn_status hn_mech_constraint_foot(hn_mech *m, const hn_constraint *k, hn_vec3 *out);

#endif
