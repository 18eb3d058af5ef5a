// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "formulations/chart/chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Projection, the null-space forms, and what depends on the choice of independent coordinates.

#define ERROR_TWO(method, figure)                                        \
    {                                                                    \
        method, 2, HN_FIGURE_ERROR, {                                    \
            .what = "largest error of an angle [rad]", .printed = figure \
        }                                                                \
    }

static const hn_figure_run projections[] = {
    ERROR_TWO("projection@rk4:h=0.02", "2.9e-6"),
    ERROR_TWO("projection@rk4:h=0.01", "1.4e-7"),
    ERROR_TWO("projection@rk4:h=0.005", "1.9e-8"),
    ERROR_TWO("projection:weight=euclidean@rk4:h=0.02", "3.2e-5"),
    ERROR_TWO("projection:weight=euclidean@rk4:h=0.01", "1.4e-6"),
    ERROR_TWO("projection:weight=euclidean@rk4:h=0.005", "6.4e-8"),
    ERROR_TWO("index1@rk4:h=0.02", "6.9e-5"),
    ERROR_TWO("index1@rk4:h=0.01", "4.4e-6"),
    ERROR_TWO("index1@rk4:h=0.005", "2.8e-7"),
    ERROR_TWO("projection:what=velocity@rk4:h=0.02", "4.3e-6"),
    ERROR_TWO("projection:what=velocity@rk4:h=0.0025", "2.6e-9"),
    ERROR_TWO("projection:what=position@rk4:h=0.02", "2.8e-5"),
    ERROR_TWO("projection:what=position@rk4:h=0.0025", "9.3e-9"),
};

void hn_figures_projection(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_figure_runs(f, &m, "fb0", projections, (int)(sizeof projections / sizeof *projections));
    static const hn_figure order = {
        .what = "order of q",
        .how = "fb0, projection@rk4, 0.02 / 2^k, 2 s",
        .printed = "4",
        .units = 0.4,
        .note = "signed errors cancel at some steps: of single halvings 2.8 to 4.6 were printed"};
    hn_figure_add(f, &order, hn_figure_order(&m, "projection@rk4:h=%h", 0.02, 6, 2));
    hn_model_close(&m);
}

#define ENERGY(method, t, figure)                             \
    {                                                         \
        method, t, HN_FIGURE_ENERGY_END, {                    \
            .what = "change of energy [J]", .printed = figure \
        }                                                     \
    }

void hn_figures_symmetric(hn_figures *f) {
    static const hn_figure_run runs[] = {
        ENERGY("projection@midpoint:h=0.05", 12.5, "-0.0099"),
        ENERGY("projection@midpoint:h=0.05", 50, "-0.24"),
        ENERGY("projection@midpoint:h=0.05", 200, "-0.94"),
        ENERGY("symmetric-projection@midpoint:h=0.05", 12.5, "0.058"),
        ENERGY("symmetric-projection@midpoint:h=0.05", 50, "0.0025"),
        ENERGY("symmetric-projection@midpoint:h=0.05", 200, "0.021"),
    };
    hn_model m;
    hn_model_open_text(&m, hn_figure_bob, NULL);
    hn_figure_runs(f, &m, "pendulum from level", runs, 6);
    hn_model_close(&m);
}

void hn_figures_nullspace(hn_figures *f) {
    static const hn_figure_run runs[] = {
        {"nullspace-as-printed@rk4:h=1e-3",
         2,
         HN_FIGURE_ENERGY_END,
         {.what = "change of energy of the form as printed [J]", .printed = "61"}},
        {"nullspace-as-printed@rk4:h=1e-3",
         2,
         HN_FIGURE_ERROR,
         {.what = "largest error of an angle [rad]", .printed = "4"}},
        {"nullspace@rk4:h=1e-3",
         2,
         HN_FIGURE_ENERGY_END,
         {.what = "change of energy of the full form [J]", .printed = "5e-10"}},
        {"nullspace-untracked@rk4:h=1e-3",
         2,
         HN_FIGURE_ERROR,
         {.what = "largest error of an angle, basis not tracked [rad]",
          .printed = "4.3",
          .instead = "3.3",
          .note = "where the basis flips follows from its factorisation, and so does the way the "
                  "motion turns round"}},
        {"nullspace:basis=orthonormal@rk4:h=1e-3",
         2,
         HN_FIGURE_ERROR,
         {.what = "largest error of an angle, basis tracked [rad]",
          .printed = "2e-11",
          .factor = 2,
          .note = "here positions are closed after each step"}},
    };
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_figure_runs(f, &m, "fb0", runs, (int)(sizeof runs / sizeof *runs));
    hn_model_close(&m);
}

// ---- charts ----

/// |det J_d| over ten seconds with coordinate `column` independent: the least, and when it first
/// vanishes (0: never).
static double least_determinant(const hn_model *m, int column, double *first_zero) {
    const int i = (column + 1) % 3, j = (column + 2) % 3;
    hn_eval *e = NULL;
    double least = HUGE_VAL, last = 0;
    hn_run *run = hn_motion_start(m, "projection@rk4:h=1e-3");
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_J, m->arena, &e), HN_OK);
    *first_zero = 0;
    while (hn_run_time(run) < 10 - 1e-9) {
        hn_sample s = {0};
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
        hn_eval_run(e, s.t, s.q, NULL);
        const double *J = hn_eval_get(e, HN_TERM_J);
        const double det = J[i] * J[3 + j] - J[j] * J[3 + i];
        if (*first_zero == 0 && det * last < 0) {
            *first_zero = s.t;
        }
        last = det;
        least = fmin(least, fabs(det));
    }
    hn_eval_free(e);
    hn_run_free(run);
    return least;
}

/// Newton iterations to 1e-13 m for each step of the crank over a turn, from the tangent or from
/// where the others were.
static double iterations(const hn_model *m, double step, int predict) {
    hn_chart chart;
    hn_diag diag = {0};
    double q[3], crank = m->q[0];
    const int n = (int)floor(6.283185307179586 / step);
    assert_int_equal(hn_chart_init(&chart, m->sys, 0, m->arena, &diag), HN_OK);
    memcpy(q, m->q, sizeof q);
    assert_int_equal(hn_chart_choose(&chart, 0, q, 0), HN_OK);
    const double tol = 1e-13 / hn_system_length(m->sys);
    assert_int_equal(hn_chart_close(&chart, &chart.here, 0, q, tol), HN_OK);
    assert_int_equal(hn_chart_settle(&chart), HN_OK);
    const long long before = chart.cost.newton;
    for (int i = 0; i < n; i++) {
        crank += step;
        if (predict) {
            hn_chart_predict(&chart, 0, &crank, q);
        } else {
            q[0] = crank;
        }
        assert_int_equal(hn_chart_close(&chart, &chart.here, 0, q, tol), HN_OK);
        assert_int_equal(hn_chart_settle(&chart), HN_OK);
    }
    const double found = (double)(chart.cost.newton - before) / n;
    hn_chart_destroy(&chart);
    return found;
}

/// A coordinate that ends at a dead point: when the run says so, and when |det J_d| vanishes on the
/// exact motion.
static void dead_point(hn_figures *f, const hn_model *m, int column, const char *method,
                       const char *printed, const char *instead) {
    double zero;
    char note[120], how[64];
    (void)least_determinant(m, column, &zero);
    (void)snprintf(note, sizeof note, "det J_d changes its sign on the exact motion at %.3f s",
                   zero);
    (void)snprintf(how, sizeof how, "fb0, %s", method);
    const hn_figure row = {.what = column == 1 ? "the coupler as coordinate ends [s]"
                                               : "the rocker as coordinate ends [s]",
                           .how = how,
                           .printed = printed,
                           .instead = instead,
                           .units = 2,
                           .note = note};
    hn_figure_add(f, &row, hn_figure_measure(m, method, 10, HN_FIGURE_STOP));
}

/// Changes of the independent coordinate where the coupler's is the one that was asked for.
static void changes(hn_figures *f) {
    hn_figure_links links = hn_figure_fb0();
    hn_model m;
    links.coupler_drives = 1;
    hn_figure_open_links(&m, &links);
    assert_int_equal(m.status, HN_OK);
    hn_figure_put(
        f, "changes of the independent coordinate, from the coupler",
        "fb0, partitioning:tau=0.2@rk4:h=1e-3, 10 s", "1",
        (double)hn_motion_summary(&m, "partitioning:tau=0.2@rk4:h=1e-3", 10).cost.chart_changes);
    hn_model_close(&m);
}

void hn_figures_charts(hn_figures *f) {
    static const struct {
        double step;
        const char *how, *tangent, *plain;
    } steps[] = {{0.1, "fb0, crank by 0.1 rad", "3.0", "3.9"},
                 {0.01, "fb0, crank by 0.01 rad", "2.0", "3.0"},
                 {0.001, "fb0, crank by 0.001 rad", "1.3", "2.0"}};
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    for (int i = 0; i < 3; i++) {
        hn_figure_put(f, "Newton iterations a step, from the tangent", steps[i].how,
                      steps[i].tangent, iterations(&m, steps[i].step, 1));
        hn_figure_put(f, "Newton iterations a step, from the last pose", steps[i].how,
                      steps[i].plain, iterations(&m, steps[i].step, 0));
    }
    double zero;
    hn_figure_put(f, "least |det J_d|, crank independent [m^2]", "fb0, 10 s", "2.1",
                  least_determinant(&m, 0, &zero));
    dead_point(f, &m, 1, "reduced:coordinate=2@rk4:h=1e-3", "1.50", "0.745");
    dead_point(f, &m, 2, "reduced:coordinate=3@rk4:h=1e-3", "1.49", "1.201");
    hn_model_close(&m);
    changes(f);
}
