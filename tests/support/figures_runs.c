// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures.h"

#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "study/cost/convergence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Whole runs and what is asked of them.

enum { MAX_Q = 64, MAX_TIMES = 8, MAX_HALVINGS = 8 };

/// Exact motions of one model at a few times.
typedef struct exact_motion {
    const hn_model *m;
    int n;
    double t[MAX_TIMES], q[MAX_TIMES][MAX_Q];
} exact_motion;

static const double *exact_at(exact_motion *x, double t) {
    for (int i = 0; i < x->n; i++) {
        if (x->t[i] == t) {
            return x->q[i];
        }
    }
    assert_true(x->n < MAX_TIMES && x->m->info.n_user <= MAX_Q);
    hn_run *run = hn_motion_start(x->m, "projection@dop853:rtol=1e-13");
    x->t[x->n] = t;
    memcpy(x->q[x->n], hn_motion_at(run, t).q, (size_t)x->m->info.n_user * sizeof(double));
    hn_run_free(run);
    return x->q[x->n++];
}

static double largest_row(const hn_model *m, hn_eval *terms, const hn_sample *s) {
    double q[MAX_Q];
    hn_system_from_user(m->sys, s->q, q);
    hn_eval_run(terms, s->t, q, NULL);
    return hn_norm_max(m->info.nc, hn_eval_get(terms, HN_TERM_PHI));
}

static double largest_rate_of_rows(const hn_model *m, hn_eval *terms, const hn_sample *s) {
    double q[MAX_Q], v[MAX_Q], rate[MAX_Q];
    assert_true(m->info.nc <= MAX_Q);
    hn_system_from_user(m->sys, s->q, q);
    hn_system_rates_from_user(m->sys, s->v, v);
    hn_eval_run(terms, s->t, q, v);
    hn_mat_vec(m->info.nc, m->info.nv, hn_eval_get(terms, HN_TERM_J), v, rate);
    return hn_norm_max(m->info.nc, rate);
}

/// Steps to t and looks at phi after each; NaN when the run stops before.
static double row_on_the_way(const hn_model *m, hn_run *run, hn_eval *terms, double t) {
    double worst = 0;
    while (hn_run_time(run) < t * (1 - 1e-12)) {
        hn_sample s = {0};
        if (hn_run_step(run) != HN_OK || hn_run_sample(run, hn_run_time(run), &s) != HN_OK) {
            return nan("");
        }
        worst = fmax(worst, largest_row(m, terms, &s));
    }
    return worst;
}

static double at_the_end(const hn_model *m, hn_run *run, hn_eval *terms, exact_motion *exact,
                         double t, hn_figure_quantity quantity) {
    hn_sample s = {0};
    if (hn_run_advance(run, t) != HN_OK || hn_run_sample(run, t, &s) != HN_OK) {
        return nan("");
    }
    const hn_run_summary all = hn_run_get_summary(run);
    switch (quantity) {
    case HN_FIGURE_ROW_END:
        return largest_row(m, terms, &s);
    case HN_FIGURE_SPEED_END:
        return largest_rate_of_rows(m, terms, &s);
    case HN_FIGURE_ENERGY_END:
        return s.energy_change;
    case HN_FIGURE_ENERGY_WORST:
        return fabs(all.worst_energy_change);
    case HN_FIGURE_NEWTON:
        return (double)all.cost.newton / (double)all.steps;
    case HN_FIGURE_ERROR:
    case HN_FIGURE_ROW:
    case HN_FIGURE_STOP:
        break;
    }
    double worst = 0;
    const double *q = exact_at(exact, t);
    for (int i = 0; i < m->info.n_user; i++) {
        worst = fmax(worst, fabs(s.q[i] - q[i]));
    }
    return worst;
}

static double measure(const hn_model *m, const char *method, double t, hn_figure_quantity quantity,
                      exact_motion *exact) {
    hn_eval *terms = NULL;
    double found = nan("");
    hn_run *run = hn_motion_start(m, method);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_PHI | HN_TERM_J, m->arena, &terms), HN_OK);
    if (quantity == HN_FIGURE_STOP) {
        found = hn_run_advance(run, t) == HN_OK ? nan("") : hn_run_get_summary(run).t;
    } else if (quantity == HN_FIGURE_ROW) {
        found = row_on_the_way(m, run, terms, t);
    } else {
        found = at_the_end(m, run, terms, exact, t, quantity);
    }
    hn_eval_free(terms);
    hn_run_free(run);
    return found;
}

double hn_figure_measure(const hn_model *m, const char *method, double t,
                         hn_figure_quantity quantity) {
    exact_motion exact = {.m = m};
    return measure(m, method, t, quantity, &exact);
}

void hn_figure_runs(hn_figures *f, const hn_model *m, const char *scene, const hn_figure_run *runs,
                    int n) {
    exact_motion exact = {.m = m};
    for (int i = 0; i < n; i++) {
        char how[200];
        hn_figure figure = runs[i].figure;
        snprintf(how, sizeof how, "%s, %s, %g s", scene, runs[i].method, runs[i].t);
        figure.how = how;
        hn_figure_add(f, &figure, measure(m, runs[i].method, runs[i].t, runs[i].quantity, &exact));
    }
}

double hn_figure_order(const hn_model *m, const char *method, double h, int n, double t) {
    exact_motion exact = {.m = m};
    double steps[MAX_HALVINGS], error[MAX_HALVINGS];
    assert_true(n <= MAX_HALVINGS);
    for (int k = 0; k < n; k++) {
        char text[HN_SPEC_MAX];
        const char *const at = strstr(method, "%h");
        assert_non_null(at);
        steps[k] = ldexp(h, -k);
        snprintf(text, sizeof text, "%.*s%.17g%s", (int)(at - method), method, steps[k], at + 2);
        error[k] = measure(m, text, t, HN_FIGURE_ERROR, &exact);
    }
    return hn_fit_order(n, steps, error);
}
