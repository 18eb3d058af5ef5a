// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_EQUILIBRATE_H
#define HN_LINALG_EQUILIBRATE_H
// Sizes from which the solvers of the saddle-point system (saddle.h, kkt.h) choose their scales:
// coordinates by the square root of their mass, massless ones by what the constraints see of them.

#include "base/status.h"

#include <stdbool.h>

/// Finds the largest diagonal entry of M (nv x nv row-major). 0 for nv = 0.
/// Fails: HN_ERR_NOT_SPD where a diagonal entry is negative; *heaviest is then untouched.
HN_MUST_CHECK hn_status hn_heaviest_mass(int nv, const double *M, double *heaviest);

/// Returns whether mass m is nothing but rounding beside the heaviest one: 1e-14 of it or less.
bool hn_is_massless(double m, double heaviest);

/// Returns the largest |J_ij| of column j of J (nc x nv row-major).
double hn_column_size(int nv, int nc, const double *J, int j);
#endif
