// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_TURN_H
#define HN_INTEGRATORS_TURN_H
// Turns do not add: the displacement of a ball from the start of a step is a rotation vector x, and
// its rate is not the angular velocity u but D(x) u, with a = |x|,
//
//     D(x) u = u + 1/2 x u + (1 - a/2 cot a/2) / a^2 x (x u),   products of vectors
//
// Source: Hairer, Lubich & Wanner 2006, IV.7.

/// Replaces the angular velocity u (3) [rad/s] by the rate of the rotation vector x (3) [rad].
void hn_turn_rate(const double *x, double *u);

#endif
