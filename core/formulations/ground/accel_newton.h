// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_ACCEL_NEWTON_H
#define HN_FORMULATIONS_ACCEL_NEWTON_H
// Newton's systems (3) of accel_jacobian.h: filled, factored and solved.

#include "formulations/ground/accel_jacobian.h"

/// Factors (3) with s = (re, im); which = 0: real, 1: complex. Fails: HN_ERR_SINGULAR,
/// HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_accel_jacobian_factor(hn_accel_jacobian *j, int which, double re,
                                                 double im);
/// x (nq + nv, in 1 or 2 parts: real and imaginary) <- (s - dF/dy)^-1 x
void hn_accel_jacobian_solve(hn_accel_jacobian *j, int parts, double *const *x);

#endif
