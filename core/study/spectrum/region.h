// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_REGION_H
#define HN_STUDY_REGION_H
// Stability regions: what a step of an integrator makes of an eigenvalue.

#include "study/spectrum/region.h"
#include "study/spectrum/spectrum.h"

/// |R(z)|: the largest growth factor of one step of the integrator on y' = s y at z = h s, found by
/// stepping; for a partitioned one, on x'' = -|s|^2 x + 2 re(s) x'. NaN: not an integrator with a
/// region of its own, see hn_stability_why_not().
double hn_stability_growth(const hn_stepper *stepper, double z_re, double z_im);
/// Why it has none ("a multistep method: ..."), NULL when it has one.
const char *hn_stability_why_not(const hn_stepper *stepper);
/// The largest step h [s] at which no eigenvalue grows: the smallest over the eigenvalues of the
/// first h on the ray where |R(h s)| = 1. Growth of the motion itself is left out: eigenvalues with
/// re > 0, but for oscillations that grow by less than a tenth of their frequency (a stiff spring
/// on links that turn), which count as undamped. In a partitioned integrator real eigenvalues act
/// in pairs, the fastest with the slowest, as those of an overdamped mode do. HUGE_VAL: no limit;
/// 0: an undamped oscillation grows at any step. NaN as above.
double hn_stability_limit(const hn_stepper *stepper, const hn_eigenvalue *s, int n);
/// The pair that Baumgarte's terms add on each row: roots of s^2 + 2 alpha s + beta^2 = 0.
void hn_stability_baumgarte(double alpha, double beta, hn_eigenvalue out[2]);

#endif
