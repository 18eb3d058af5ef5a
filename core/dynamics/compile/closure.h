// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_CLOSURE_H
#define HN_DYNAMICS_CLOSURE_H
// Building blocks of closure rows: two ends seen from their common ancestor, directions fixed to
// them, and the gap between them. Cut joints (loops.c) and constraints beside the joints
// (constraints.c) are written with them.
//
// A row also has the wrench of its multiplier: lambda `force` acts on end b at its point and
// opposite on end a at its own, lambda `moment_a` and lambda `moment_b` on the two bodies. Their
// power is lambda times the rate of the row.

#include "dynamics/compile/relate.h"

#include <stdbool.h>

/// A direction fixed to one end, with its first derivative and the second at zero u-dot, in the
/// closure's frame.
typedef struct hn_direction {
    const hn_reach *end;
    hn_vec3 v, d1, d2;
} hn_direction;

typedef struct hn_closure {
    hn_mech *m;
    int index; ///< loop
    const char *name, *pointer;
    int link[2];    ///< of ends a and b
    hn_vec3 arm[2]; ///< of the two points, in E of their links
    hn_relative rel;
    hn_vec3 delta, delta_rate, delta_acc; ///< end a minus end b
    int n;                                ///< coordinates met, those of end a first
    int *coordinate;
    hn_vec3 *coefficient; ///< d delta / d u
    hn_entry *entries;    ///< scratch of a row
    hn_row_wrench wrench; ///< of the row that is being made
} hn_closure;

/// The gap, or a part of it, as one number; its derivatives are in the closure's entries.
typedef struct hn_measured {
    hn_ex value, gamma;
    int n; ///< of entries
} hn_measured;

/// Begins a closure: point `at_a` (3 quantities, body axes) of link a against point `at_b` of link
/// b. Memory from the system's arena.
HN_MUST_CHECK hn_status hn_closure_begin(hn_mech *m, int index, int a, const hn_quantity *at_a,
                                         int b, const hn_quantity *at_b, hn_closure *out);
/// Fills delta, delta_acc and the coefficients.
void hn_closure_collect(hn_closure *c);
/// Fills delta_rate, which the rows of a revolute joint do not need.
void hn_closure_collect_rate(hn_closure *c);
/// `v` in the axes of the body at end a (0) or b (1).
hn_direction hn_closure_direction(const hn_closure *c, int end, const double v[3]);
/// The gap along a direction that moves with one end; fills the entries, and the wrench of a row
/// that holds the gap. Needs delta_rate.
hn_measured hn_closure_along(hn_closure *c, const hn_direction *p);
/// Adds e to the derivative along a coordinate among the first n entries; returns their number
/// then.
int hn_closure_add_entry(hn_closure *c, int n, int coordinate, hn_ex e);
/// Adds the row of component i of the gap in the closure's frame.
HN_MUST_CHECK hn_status hn_closure_position_row(hn_closure *c, int i);
/// Adds the row that keeps p on end a perpendicular to r on end b.
HN_MUST_CHECK hn_status hn_closure_perpendicular_row(hn_closure *c, const char *what,
                                                     const hn_direction *p, const hn_direction *r);
/// Adds a row whose entries and wrench are set, under the name "name: what".
HN_MUST_CHECK hn_status hn_closure_add_row(hn_closure *c, const char *what, bool is_length,
                                           hn_ex phi, hn_ex gamma, int n);
#endif
