// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/order_runs.h"

#include "study/cost/convergence.h"
#include "support/near.h"

#include <math.h>

/// The largest difference of a coordinate at T; NaN where the run ends early.
static double error_of(const hn_system *sys, const hn_method_spec *spec, const double *q,
                       const double *v, double T, const double *reference) {
    hn_run *run = NULL;
    hn_sample sample;
    hn_diag diag = {0};
    if (hn_run_create(sys, spec, q, v, NULL, &run, &diag) != HN_OK) {
        fail_msg("%s: %s", spec->formulation->name, diag.message);
    }
    double worst = (double)NAN;
    if (hn_run_advance(run, T) == HN_OK && hn_run_sample(run, T, &sample) == HN_OK) {
        worst = 0;
        for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
            worst = fmax(worst, fabs(sample.q[i] - reference[i]));
        }
    }
    hn_run_free(run);
    return worst;
}

void hn_order_runs_make(const hn_system *sys, const hn_method_spec *spec, const double *q,
                        const double *v, double T, int n, const double *reference, double floor,
                        hn_order_runs *out) {
    hn_method_spec finer = *spec;
    double fitted[HN_ORDER_RUNS];
    double *size = hn_method_find_option(&finer, hn_method_is_adaptive(spec) ? "rtol" : "h", NULL);
    assert_in_range(n, 1, HN_ORDER_RUNS);
    assert_non_null(size);
    for (int i = 0; i < n; i++) {
        out->h[i] = *size;
        out->error[i] = error_of(sys, &finer, q, v, T, reference);
        fitted[i] = out->error[i] > floor ? out->error[i] : 0; // 0 is left out of the fit
        *size *= 0.5;
    }
    out->order = hn_fit_order(n, out->h, fitted);
}
