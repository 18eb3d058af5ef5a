// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TEST_ORDER_RUNS_H
#define HN_TEST_ORDER_RUNS_H
// Runs of one method over h, h/2, h/4, ... against a reference state, and their order.

#include "study/run/run.h"

enum { HN_ORDER_RUNS = 12 };

typedef struct hn_order_runs {
    double h[HN_ORDER_RUNS];     ///< step sizes (fixed) or relative tolerances (adaptive)
    double error[HN_ORDER_RUNS]; ///< max |q - reference| at the end; NaN: the run ended early
    double order;                ///< fitted to the errors above `floor` of the runs that finished
} hn_order_runs;

/// Makes n runs (at most HN_ORDER_RUNS) from (q, v) to time T [s], the first as `spec` says.
/// `reference` in user coordinates, right to `floor`. A method that cannot be started is a failure
/// of the test.
void hn_order_runs_make(const hn_system *sys, const hn_method_spec *spec, const double *q,
                        const double *v, double T, int n, const double *reference, double floor,
                        hn_order_runs *out);

#endif
