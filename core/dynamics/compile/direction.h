// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_DIRECTION_H
#define HN_DYNAMICS_DIRECTION_H
// Derivatives along velocities, for balls too, whose velocities are no rates of coordinates.

#include "dynamics/compile/system_impl.h"

enum { HN_DIRECTION_MOST = 4 }; ///< entries of q that one velocity moves: those of a quaternion

/// The entries of q that velocity j moves: their symbols and rates at v_j = 1, all others 0.
/// Returns how many.
int hn_direction_of_speed(const hn_system *sys, int j, int symbols[HN_DIRECTION_MOST],
                          hn_ex seed[HN_DIRECTION_MOST]);
#endif
