// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_BUNCH_KAUFMAN_H
#define HN_LINALG_BUNCH_KAUFMAN_H
// Dense P A P' = L D L' of a symmetric indefinite matrix, D with 1 x 1 and 2 x 2 blocks chosen by
// size: stable whatever the order of the unknowns. Source: Bunch & Kaufman 1977 (partial pivoting,
// growth bound alpha = (1 + sqrt 17) / 8).

#include "base/status.h"

/// Factors A (n x n row-major, both triangles, overwritten); pivot (n): row exchanged at step k,
/// negative - 1 for both rows of a 2 x 2 block. *negative (may be NULL): negative eigenvalues, from
/// D. Fails: HN_ERR_SINGULAR when a column of what is left is not above tol (absolute: scale the
/// matrix first) or not a number.
HN_MUST_CHECK hn_status hn_bunch_kaufman(int n, double *A, int *pivot, double tol, int *negative);
/// x (n) <- A^-1 x.
void hn_bunch_kaufman_solve(int n, const double *A, const int *pivot, double *x);

#endif
