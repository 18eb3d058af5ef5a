// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/convergence.h"

#include <math.h>

double hn_fit_order(int n, const double *x, const double *y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    int used = 0;
    for (int i = 0; i < n; i++) {
        if (!(x[i] > 0) || !(y[i] > 0) || !isfinite(x[i]) || !isfinite(y[i])) {
            continue;
        }
        const double a = log(x[i]), b = log(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
        used++;
    }
    const double spread = used * sxx - sx * sx;
    return used >= 2 && spread > 0 ? (used * sxy - sx * sy) / spread : nan("");
}

static double max_difference(int n, const double *x, const double *y) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        worst = fmax(worst, fabs(x[i] - y[i]));
    }
    return worst;
}

/// What the error is set by.
static double *accuracy(hn_method_spec *spec) {
    return hn_method_find_option(spec, hn_method_is_adaptive(spec) ? "rtol" : "h", NULL);
}

static hn_status run_one(const hn_system *sys, const hn_method_spec *spec, const double *q,
                         const double *v, double T, const double *ref_q, const double *ref_v, int i,
                         hn_convergence *out, hn_diag *diag) {
    hn_run *run = NULL;
    hn_sample sample;
    const hn_status made = hn_run_create(sys, spec, q, v, NULL, &run, diag);
    if (made != HN_OK) {
        return made;
    }
    hn_status status = hn_run_advance(run, T);
    HN_THEN(status, hn_run_sample(run, T, &sample));
    const hn_run_summary summary = hn_run_get_summary(run);
    const int n_user = hn_system_get_info(sys).n_user;
    out->status[i] = status;
    out->gap[i] = summary.worst_gap;
    out->energy[i] = summary.worst_energy_change;
    out->cost[i] = summary.cost;
    out->err_q[i] = status == HN_OK ? max_difference(n_user, sample.q, ref_q) : nan("");
    out->err_v[i] = status == HN_OK ? max_difference(n_user, sample.v, ref_v) : nan("");
    hn_run_free(run);
    return HN_OK;
}

hn_status hn_convergence_run(const hn_system *sys, const hn_method_spec *spec, const double *q,
                             const double *v, double T, int n, double ratio, const double *ref_q,
                             const double *ref_v, double floor, hn_convergence *out,
                             hn_diag *diag) {
    hn_method_spec finer = *spec;
    double fitted[HN_CONVERGENCE_MAX];
    double *size = accuracy(&finer);
    if (n < 1 || n > HN_CONVERGENCE_MAX || !(T > 0) || !(ratio > 0 && ratio < 1) || !size) {
        return hn_diag_set(
            diag, HN_ERR_INPUT, NULL, NULL,
            "a convergence study needs 1 to %d runs, T > 0 and a ratio between 0 and 1",
            HN_CONVERGENCE_MAX);
    }
    *out = (hn_convergence){.n = n, .floor = floor};
    for (int i = 0; i < n; i++) {
        out->h[i] = *size;
        const hn_status status = run_one(sys, &finer, q, v, T, ref_q, ref_v, i, out, diag);
        if (status != HN_OK) {
            return status;
        }
        fitted[i] = out->err_q[i] > floor ? out->err_q[i] : 0; // 0 is left out of the fit
        *size *= ratio;
    }
    out->order = hn_fit_order(n, out->h, fitted);
    return HN_OK;
}
