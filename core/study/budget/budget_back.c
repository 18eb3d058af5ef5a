// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/budget/budget_back.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"

#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define TRANSPORT_TOL 1e-9 // of flows whose derivative carries parts to the end
#define REFERENCE "projection@dop853:rtol=1e-13"

/// Splits a displacement d (2 nv) at the state of `linear` and `saddle`: the part that opens the
/// loops goes to b->split, the part along their motion stays in d.
static hn_status split_off(hn_budget_work *b, double *d) {
    const int nv = b->info.nv, nc = b->info.nc;
    double *off = b->split;
    memset(off, 0, (size_t)b->nd * sizeof *off);
    if (nc == 0) {
        return HN_OK;
    }

    // position: the smallest displacement that takes J d to 0
    const double *J = hn_linear_get(b->linear, HN_LINEAR_J);
    const double *V = hn_linear_get(b->linear, HN_LINEAR_V);
    hn_saddle_info info = {0};
    hn_mat_vec(nc, nv, J, d, b->gap);
    for (int i = 0; i < nc; i++) {
        b->gap[i] = -b->gap[i];
    }
    hn_status status = hn_saddle_apply(b->zero, b->gap, off, b->lambda, &info, b->saddle);
    hn_axpy(nv, -1, off, d);

    // velocity: the same for J dv + V dq, V being the derivative of J v by q
    for (int i = 0; i < nc; i++) {
        b->gap[i] = -hn_dot(nv, J + i * nv, d + nv) - hn_dot(nv, V + i * nv, d);
    }
    HN_THEN(status, hn_saddle_apply(b->zero, b->gap, off + nv, b->lambda, &info, b->saddle));
    hn_axpy(nv, -1, off + nv, d + nv);
    return status;
}

static hn_status prepare_split(hn_budget_work *b, double t, const double *y) {
    hn_saddle_opts opts = hn_saddle_opts_default();
    hn_saddle_info info;
    opts.residual_tol =
        HUGE_VAL; // a displacement need not lie in the range of rows that depend on others
    hn_linear_run(b->linear, t, y, y + b->info.nq, NULL, NULL);
    return hn_saddle_factor(b->info.nv, b->info.nc, hn_linear_get(b->linear, HN_LINEAR_M),
                            hn_linear_get(b->linear, HN_LINEAR_J), &info, &opts, b->saddle);
}

/// Adds what the parts of step k have become at T, w being the derivative of the coordinate there
/// by the state at the step's end.
static hn_status settle(hn_budget_work *b, size_t k, const double *y_end) {
    static const hn_cause cause_of[HN_PARTS] = {HN_CAUSE_TRUNCATION, HN_CAUSE_FORMULATION,
                                                HN_CAUSE_PROJECTION};
    double *r = hn_budget_work_record(b, k), *part = r + 2 + b->ny;
    hn_status status = prepare_split(b, r[0] + r[1], y_end);
    for (int p = 0; status == HN_OK && p < HN_PARTS; p++) {
        double *d = part + p * b->nd;
        status = split_off(b, d);
        b->out->part[cause_of[p]] += hn_dot(b->nd, b->w, d);
        b->out->part[HN_CAUSE_DRIFT] += hn_dot(b->nd, b->w, b->split);
    }
    return status;
}

static hn_status slopes_back(void *self, double t, const double *y, const double *w, double *out) {
    const hn_budget_work *b = self;
    HN_TRY(hn_accel_jacobian_at(b->slopes, t, y, y + b->info.nq, &(hn_accel_law){0}));
    HN_TRY(hn_accel_jacobian_prepare(b->slopes));
    hn_accel_jacobian_back(b->slopes, w, out);
    return HN_OK;
}

/// w <- A' w with A the derivative of the flow I over step k by its start.
static hn_status carry_back(hn_budget_work *b, size_t k) {
    const double *r = hn_budget_work_record(b, k);
    const hn_flow_slopes slopes = {b->nd, b, slopes_back};
    return hn_flow_carry_back(b->carrier, &b->plain, &slopes, TRANSPORT_TOL, r[0], r[1], r + 2,
                              b->w);
}

static hn_status settle_all(hn_budget_work *b, hn_diag *diag) {
    const double *y_end = b->y; // of the last step
    double at = b->out->t;
    hn_status status = HN_OK;
    hn_budget_work_present(b, b->y);
    for (size_t k = b->kept; status == HN_OK && k-- > 0;) {
        at = hn_budget_work_record(b, k)[0];
        if (k % HN_BOOKS_BETWEEN_QUESTIONS == 0 &&
            hn_budget_work_asked_to_stop(b, 0.4 + 0.6 * (1 - (double)k / (double)b->kept))) {
            return hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "stopped on request");
        }
        status = settle(b, k, y_end);
        status = status == HN_OK && k > 0 ? carry_back(b, k) : status;
        y_end = hn_budget_work_record(b, k) + 2;
    }
    b->stuck = at;
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, HN_ERR_NO_CONVERGENCE, NULL, NULL,
                                         "its parts could not be carried on from t = %.4g s: %s",
                                         at, hn_status_text(status));
}

/// The end of another run to the same time, user coordinates into `out`; 0 when it did not get
/// there, and then *t is where it got [s].
static int end_of(const hn_budget_work *b, const hn_method_spec *spec, double T, double *out,
                  double *t) {
    hn_run *run = NULL;
    hn_sample sample;
    const hn_run_opts opts = hn_run_opts_default();
    int arrived = 0;
    *t = 0;
    if (hn_run_create(b->sys, spec, b->steps->start.q, b->steps->start.v, &opts, &run, NULL) ==
        HN_OK) {
        hn_run_watch(run, 0);
        const double early = hn_method_is_adaptive(spec) ? 0 : 1e-9 * hn_run_stepping(run)->h_next;
        arrived =
            hn_run_advance(run, T - early) == HN_OK && hn_run_sample(run, T, &sample) == HN_OK;
        if (arrived) {
            memcpy(out, sample.q, (size_t)b->info.n_user * sizeof *out);
        }
        *t = hn_run_get_summary(run).t;
    }
    hn_run_free(run);
    return arrived;
}

/// Error of every user coordinate at the end, of them the one asked for or the largest as the
/// budget's; w begins as that coordinate's derivative.
static hn_status choose_coordinate(hn_budget_work *b, const double *reference, hn_diag *diag) {
    const int n = b->info.n_user, nv = b->info.nv;
    double *q = b->up, *delta = b->split, *user = b->column;
    const hn_scene *scene = hn_system_scene(b->sys);
    double worst = -1;

    // the user coordinate with the largest error; lengths are compared by that of the mechanism
    hn_system_from_user(b->sys, reference, q);
    hn_system_difference(b->sys, q, b->steps->now.q, delta);
    hn_system_rates_to_user(b->sys, delta, user);
    for (int i = 0; i < n; i++) {
        const int length =
            scene->coordinates[hn_system_user_coordinate(b->sys, i)].kind == HN_LENGTH;
        const double size = fabs(user[i]) / (length ? hn_system_length(b->sys) : 1);
        const bool allowed = b->opts->coordinate <= 0 || b->opts->coordinate == i + 1;
        if (allowed && size > worst) {
            worst = size;
            b->out->coordinate = i;
            b->out->error = user[i];
        }
    }

    if (b->out->coordinate < 0) {
        return hn_diag_set(diag, HN_ERR_DIVERGED, NULL, NULL, "the end of the run is not finite");
    }

    // its derivative by the state at the end
    memset(b->w, 0, (size_t)b->nd * sizeof *b->w);
    for (int i = 0; i < nv; i++) {
        memset(b->a, 0, (size_t)nv * sizeof *b->a);
        b->a[i] = 1;
        hn_system_rates_to_user(b->sys, b->a, user);
        b->w[i] = user[b->out->coordinate];
    }
    return HN_OK;
}

/// Returns the difference that one option of the method makes to the coordinate at the end, by a
/// second run. NaN where the method has no such option, or where it chooses its steps: they would
/// change with the option.
static double told_by(const hn_budget_work *b, const char *key, double value, double T) {
    hn_method_spec spec = *hn_run_spec(b->run);
    double *end = b->up, *delta = b->split, *q = b->down, *user = b->column, t;
    double *setting = hn_method_find_option(&spec, key, NULL);
    if (!setting || *setting == value || b->steps->adaptive) {
        return (double)NAN;
    }
    *setting = value;
    if (!end_of(b, &spec, T, end, &t)) {
        return (double)NAN;
    }
    hn_system_from_user(b->sys, end, q);
    hn_system_difference(b->sys, q, b->steps->now.q, delta);
    hn_system_rates_to_user(b->sys, delta, user);
    return user[b->out->coordinate];
}

static void separate_rounding(hn_budget_work *b, double T) {
    hn_budget *out = b->out;
    out->part[HN_CAUSE_ROUNDING] = told_by(b, "sum", 1, T);
    out->part[HN_CAUSE_SOLVE] = told_by(b, "solver", HN_SOLVER_DENSE, T);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        out->sum += isfinite(out->part[i]) && i != HN_CAUSE_ROUNDING && i != HN_CAUSE_SOLVE
                        ? out->part[i]
                        : 0;
    }
    for (int i = HN_CAUSE_SOLVE; i <= HN_CAUSE_ROUNDING; i++) {
        out->part[HN_CAUSE_TRUNCATION] -= isfinite(out->part[i]) ? out->part[i] : 0;
    }
}

/// User coordinates of the exact motion at the run's end. The caller's are for the end that was
/// asked for, which fixed steps may miss.
static hn_status find_exact(hn_budget_work *b, double T, double *out, hn_diag *diag) {
    hn_method_spec spec;
    if (b->opts->exact && fabs(T - b->asked) <= HN_BOOKS_ARRIVED * b->asked) {
        memcpy(out, b->opts->exact, (size_t)b->info.n_user * sizeof *out);
        return HN_OK;
    }
    const hn_status status = hn_method_parse(REFERENCE, &spec, diag);
    double t;
    if (status == HN_OK && !end_of(b, &spec, T, out, &t)) {
        b->stuck = t;
        return hn_diag_set(diag, HN_ERR_NO_CONVERGENCE, NULL, NULL,
                           "the exact motion (%s) ended at t = %.4g s", REFERENCE, t);
    }
    return status;
}

hn_status hn_budget_work_look_back(hn_budget_work *b, double T, hn_diag *diag) {
    double *exact = b->y_own;
    HN_TRY(find_exact(b, T, exact, diag));
    HN_TRY(choose_coordinate(b, exact, diag));
    HN_TRY(settle_all(b, diag));
    separate_rounding(b, T);
    return HN_OK;
}
