// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CONVERGENCE_H
#define HN_STUDY_CONVERGENCE_H
// Observed order: the same method over h, h/2, h/4, ... against a reference state.

#include "study/run/run.h"

/// Slope of the least-squares line through (log x_i, log y_i); NaN for fewer than two positive
/// pairs.
double hn_fit_order(int n, const double *x, const double *y);

enum { HN_CONVERGENCE_MAX = 12 };

typedef struct hn_convergence {
    int n;
    double h[HN_CONVERGENCE_MAX];     ///< step sizes (fixed) or relative tolerances (adaptive)
    double err_q[HN_CONVERGENCE_MAX]; ///< max |q - reference| at the end, user coordinates
    double err_v[HN_CONVERGENCE_MAX];
    double gap[HN_CONVERGENCE_MAX];    ///< worst over the run
    double energy[HN_CONVERGENCE_MAX]; ///< worst change over the run [J]
    hn_cost cost[HN_CONVERGENCE_MAX];
    hn_status status[HN_CONVERGENCE_MAX];
    double order; ///< fitted to err_q over the runs that finished
    double floor; ///< errors below this are the reference's own and were left out of the fit
} hn_convergence;

/// Runs `spec` from (q, v) to time T with n step sizes (tolerances), each the last one times
/// `ratio`. `ref_q`, `ref_v` in user coordinates, right to `floor`. Runs that fail stay in the
/// table with their status. Fails: HN_ERR_INPUT (n, T, ratio), HN_ERR_UNSUPPORTED, HN_ERR_MEMORY,
/// with diag.
HN_MUST_CHECK hn_status hn_convergence_run(const hn_system *sys, const hn_method_spec *spec,
                                           const double *q, const double *v, double T, int n,
                                           double ratio, const double *ref_q, const double *ref_v,
                                           double floor, hn_convergence *out, hn_diag *diag);

#endif
