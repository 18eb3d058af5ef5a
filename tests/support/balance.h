// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_BALANCE_H
#define HN_SUPPORT_BALANCE_H
// Newton and Euler for every body of a scene with the wrenches of its joints, from poses alone:
// bodies are placed joint by joint from the scene's own coordinates, and their accelerations are
// differences of those poses.

#include "dynamics/reactions/reactions.h"

typedef struct balance {
    double force, moment;                 ///< largest residual over all bodies [N], [N m]
    double largest_force, largest_moment; ///< of what went in
    double on_ground[3];     ///< sum of the forces of joints and constraints on the ground [N]
    double momentum_rate[3]; ///< of all bodies [N]
    double weight[3];
    /// of the differences [s]: they leave (speed step)^4 of accelerations, and rounding over step^2
    double step;
    double power; ///< of all joint and constraint wrenches together [W]
} balance;

/// At a state with its accelerations (system coordinates). Springs between points, forces and
/// moments on bodies are worked out from the scene; what acts along coordinates is in the wrenches.
balance balance_of(const hn_system *sys, double t, const double *q, const double *v,
                   const double *a, const hn_wrench *joints, const hn_wrench *constraints);
#endif
