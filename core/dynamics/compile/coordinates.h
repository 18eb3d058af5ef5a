// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_COORDINATES_H
#define HN_DYNAMICS_COORDINATES_H
// Positions and velocities of a system: to and from the scene's coordinates, and along a velocity.
// See system.h for the two sets of coordinates.

#include "dynamics/compile/system.h"

#include <stdbool.h>

// ---- user <-> system: constant linear maps but for orientations ----

/// Positions: q (nq) to user_q (nv) and back.
void hn_system_to_user(const hn_system *sys, const double *q, double *user_q);
void hn_system_from_user(const hn_system *sys, const double *user_q, double *q);
/// Velocities or accelerations (without offset): v (nv) to user_v (nv) and back.
void hn_system_rates_to_user(const hn_system *sys, const double *v, double *user_v);
void hn_system_rates_from_user(const hn_system *sys, const double *user_v, double *v);
/// Generalised forces: user_f = T' f, such that the power is the same.
void hn_system_forces_to_user(const hn_system *sys, const double *f, double *user_f);

// ---- positions along velocities ----

/// Writes qdot = G(q) v; a copy when nq == nv. A ball (spherical or free joint) has four entries of
/// q, a unit quaternion, and three of v, the angular velocity in the child's axes; every other
/// coordinate has one of each.
void hn_system_kinematics(const hn_system *sys, const double *q, const double *v, double *qdot);
/// Moves q by `delta` (nv, a velocity times a time), so that quaternions stay unit: for Newton
/// corrections and interpolation. A plain sum when nq == nv.
void hn_system_move(const hn_system *sys, double *q, const double *delta);
/// Writes the `delta` (nv) that moves `from` to `to`; of two ways round the shorter.
void hn_system_difference(const hn_system *sys, const double *from, const double *to,
                          double *delta);
/// Scales quaternions to length 1, from which a step of an integrator deviates by its local error.
/// Returns whether q changed.
bool hn_system_normalise(const hn_system *sys, double *q);

#endif
