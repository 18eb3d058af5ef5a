// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_LINEAR_SOLVE_H
#define HN_INTEGRATORS_IMPLICIT_LINEAR_SOLVE_H
// The right-hand sides of the linear systems of implicit_linear.h: from the residuals (r1, r2, r3,
// r3') to those of matrix (2) or (3), and from its unknowns back to (x, w, l, m).

#include "integrators/implicit/implicit_linear.h"

/// Solves (1) in place with the matrix factored last: r holds (r1, r2, r3, r3') on entry and
/// (x, w, l, m) on return, in one part (real) or two (complex). r3' and m: GGL only.
void hn_implicit_linear_solve(hn_implicit_linear *l, hn_parts r);
#endif
