// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LOOPS_H
#define HN_DYNAMICS_LOOPS_H
// Loop closures: every cut joint as rows between its two halves; the derivation is in loops.c.

#include "dynamics/compile/mech.h"

#include <stdbool.h>

/// Adds the closure rows of every cut joint.
HN_MUST_CHECK hn_status hn_mech_trace_loops(hn_mech *m);
/// Writes the position rows of spatial loops a second time, seen from their legs (leg.h).
HN_MUST_CHECK hn_status hn_mech_trace_legs(hn_mech *m);
/// Writes the scene coordinates of cut joints as expressions, where they have one.
HN_MUST_CHECK hn_status hn_mech_cut_coordinates(hn_mech *m);

/// The directions of its two halves that a cut joint keeps parallel, pointing the same way.
typedef struct hn_joint_ties {
    bool axes, refs;
} hn_joint_ties;
hn_joint_ties hn_joint_ties_of(hn_joint_type type);

/// The angle of link b against link a about an axis of a, as a difference of two absolute angles.
typedef struct hn_turn {
    double sign;
    int speed[2];      ///< velocities of a and b, -1: does not turn
    hn_ex angle, rate; ///< sign (theta_b - theta_a + constant), sign (theta_b' - theta_a')
} hn_turn;
/// Writes the angle of link b against link a. Directions are in body axes; the angle is 0 where
/// ref_b lies on ref_a, seen along the axis.
/// Returns 0 if the links do not turn about parallel axes along this one, or a ref lies along it.
bool hn_mech_relative_turn(hn_mech *m, int a, const double axis[3], const double ref_a[3], int b,
                           const double ref_b[3], hn_turn *out);

#endif
