// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_SVD_H
#define HN_LINALG_SVD_H
// Singular values for reports (GSL). Not for use inside a step: cost about 10 m n^2 operations.

#include "base/arena.h"
#include "base/status.h"

/// Singular values of A (rows x cols, row-major), falling: sigma (min(rows, cols)). Scratch comes
/// from `arena`.
/// Fails: HN_ERR_MEMORY, HN_ERR_DIVERGED (an entry is not finite), sigma untouched.
HN_MUST_CHECK hn_status hn_singular_values(int rows, int cols, const double *A, double *sigma,
                                           hn_arena *arena);

/// Number of singular values above tol * sigma[0]; 0 when all vanish.
int hn_rank_of(int n, const double *sigma, double tol);
/// sigma_max / sigma_min over all n, HUGE_VAL when the smallest vanishes, 1 when n = 0.
double hn_condition_of(int n, const double *sigma);

#endif
