// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_MASS_SCALES_H
#define HN_DYNAMICS_MASS_SCALES_H
// diag(M)^-1/2, by which the columns of J are compared whatever the units of the coordinates are.

#include "dynamics/evaluate/eval.h"

/// d (nv) = M_jj^-1/2 at the state that `eval` was run at last (HN_TERM_M). A velocity without mass
/// counts as the heaviest: below 1e-14 of it, with lengths measured in lengths of the mechanism, so
/// that a mechanism of any size has the same ones.
void hn_mass_scales(const hn_system *sys, const hn_eval *eval, double *d);

#endif
