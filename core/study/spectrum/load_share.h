// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_LOAD_SHARE_H
#define HN_STUDY_LOAD_SHARE_H
// Finds the load that makes a mode of the motion fast: a motor's damping, a stiff spring.

#include "dynamics/compile/system.h"

/// A state and a direction of motion there.
typedef struct hn_mode_at {
    double t;
    const double *q, *v; ///< nq, nv
    const double *x;     ///< nv, x' M x = 1
    bool damped;         ///< the load acts against velocities along x, else against displacements
} hn_mode_at;

/// Returns the load whose force against a motion along x is the largest, where it makes a good
/// part of `rate`: x' C x [1/s] of a damped mode, x' K x [1/s^2] of a vibration. NULL where none
/// does, or where it cannot be found (no memory, too many loads).
///
/// Each load's force is the difference that leaving it out of the scene makes, so any formula
/// serves. Costs one compilation of the scene a load; allocates.
const hn_load *hn_load_share_find(const hn_system *sys, const hn_mode_at *mode, double rate);

#endif
