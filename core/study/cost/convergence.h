// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CONVERGENCE_H
#define HN_STUDY_CONVERGENCE_H
// The observed order of a method, from its errors over several step sizes.

/// Returns the slope of the least-squares line through (log x_i, log y_i); NaN for fewer than two
/// positive pairs.
double hn_fit_order(int n, const double *x, const double *y);

#endif
