// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_LAGRANGIAN_TURNS_H
#define HN_SUPPORT_LAGRANGIAN_TURNS_H
// The turns of the augmented Lagrangian on a four-bar of three speeds and two rows: each shrinks
// the error of the accelerations along an eigenvector of S = J M^-1 J' by 1 / (1 + a s).

#include "support/model.h"

/// Eigenvalues of S at the assembled state, the smaller first.
void hn_turns_eigenvalues(const hn_model *m, double s[2]);
/// Largest error of an acceleration there after so many turns with the weight a.
double hn_turns_error(const hn_model *m, double a, int turns);
#endif
