// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_QUATERNION_H
#define HN_DYNAMICS_QUATERNION_H
// Rotations of balls. A unit quaternion (w, x, y, z) = (cos a/2, sin a/2 n) stands for the turn R
// by the angle a about the unit vector n; it takes vectors from the joint's axes on its child to
// those on its parent. Angular velocities are in the child's axes:
//     q' = 1/2 q o (0, omega),     moved by delta: q o exp(delta / 2)                          (1)
//
// Source: Hairer, Lubich & Wanner 2006, sec. VII.5; Shoemake 1985.

#include <stdbool.h>

/// Computes the unit quaternion q of a rotation vector r (axis times angle [rad]).
void hn_quat_exp(const double r[3], double q[4]);
/// The rotation vector, no longer than pi; q need not have length 1. Zero quaternions give zero.
void hn_quat_log(const double q[4], double r[3]);
/// out = a o b; out may be a or b.
void hn_quat_mul(const double a[4], const double b[4], double out[4]);
/// q <- q o exp(delta / 2).
void hn_quat_move(double q[4], const double delta[3]);
/// The delta that moves `from` to `to`, the shorter way.
void hn_quat_difference(const double from[4], const double to[4], double delta[3]);
/// q' of (1).
void hn_quat_rate(const double q[4], const double omega[3], double rate[4]);
/// Brings the length back to 1 where it is off by more than rounding. Returns whether q changed.
bool hn_quat_normalise(double q[4]);
#endif
