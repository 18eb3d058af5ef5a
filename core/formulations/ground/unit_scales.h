// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_UNIT_SCALES_H
#define HN_FORMULATIONS_UNIT_SCALES_H
// The unit of each velocity, by which metres and radians can be compared: a radian, the
// characteristic length of the mechanism, and 1 / sqrt(M_jj) for a coordinate that is neither an
// angle nor a length. The same mechanism in other units of length, mass and time then has the same
// numbers.
//
// Masses are no such unit: with a light crank and a heavy slider, the slider would stay the
// independent coordinate until close to its dead points, where the crank turns a hundred times as
// fast as it.

#include "dynamics/compile/system.h"

/// scale (nv) for a system whose mass matrix has M_jj = mass[j * apart] on its diagonal at the
/// present configuration: `apart` is nv + 1 where `mass` is the matrix itself, and 1 where it is
/// the diagonal alone.
void hn_unit_scales(const hn_system *sys, const double *mass, int apart, double *scale);

#endif
