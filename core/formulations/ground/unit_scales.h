// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_UNIT_SCALES_H
#define HN_FORMULATIONS_UNIT_SCALES_H
// What counts as one for each velocity, so that metres and radians can be compared: a radian, the
// characteristic length of the mechanism, and 1 / sqrt(M_jj) for a coordinate that is neither. The
// same mechanism in other units of length, mass and time then has the same numbers.
//
// Masses would be no measure for the others: of a light crank and a heavy slider the slider would
// be kept as independent coordinate up to the very neighbourhood of its dead points, where the
// crank follows from it a hundred times as fast.

#include "dynamics/compile/system.h"

/// scale (nv) for a system whose mass matrix has M_jj = mass[j * apart] on its diagonal at the
/// present configuration: `apart` is nv + 1 where `mass` is the matrix itself, and 1 where it is
/// the diagonal alone.
void hn_unit_scales(const hn_system *sys, const double *mass, int apart, double *scale);

#endif
