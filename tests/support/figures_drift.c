// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"
#include "study/cost/convergence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// The unstabilised form, and Baumgarte's: how gaps drift and decay, and what alpha does to the
// motion.

// ---- drift ----

void hn_figures_drift(hn_figures *f) {
    static const double times[] = {5, 10, 20, 40};
    static const char *const methods[] = {"index1@rk4:h=0.02", "index1@rk4:h=0.01"};
    double gap[2][4];
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 4; i++) {
            gap[k][i] = hn_figure_measure(&m, methods[k], times[i], HN_FIGURE_ROW);
        }
    }
    hn_figure_put(f, "largest |phi_i| / t^2 [m/s^2]", "fb0, index1@rk4:h=0.02, 10 s", "4.3e-5",
                  gap[0][1] / 100);
    hn_figure_put(f, "largest |phi_i| / t^2 [m/s^2]", "fb0, index1@rk4:h=0.01, 10 s", "2.7e-6",
                  gap[1][1] / 100);
    static const hn_figure power = {.what = "power of t in |phi_i|",
                                    .how = "fb0, index1@rk4:h=0.01, 5 to 40 s",
                                    .printed = "2",
                                    .units = 0.1},
                           ratio = {.what = "|phi_i| at h over that at h / 2",
                                    .how = "fb0, index1@rk4:h=0.02, 10 s",
                                    .printed = "16",
                                    .units = 2};
    hn_figure_add(f, &power, hn_fit_order(4, times, gap[1]));
    hn_figure_add(f, &ratio, gap[0][1] / gap[1][1]);
    hn_model_close(&m);

    hn_model_open_text(&m, hn_figure_bob, NULL);
    static const hn_figure_run runs[] = {
        {"index1@rk4:h=1e-2",
         10,
         HN_FIGURE_ROW,
         {.what = "largest |phi| [m^2]", .printed = "4e-5"}},
        {"index1@rk4:h=1e-2",
         100,
         HN_FIGURE_ROW,
         {.what = "largest |phi| [m^2]", .printed = "4e-3"}},
        {"index1@rk4:h=1e-2",
         2000,
         HN_FIGURE_STOP,
         {.what = "the bob leaves its rod [s]",
          .printed = "989.18",
          .factor = 1.1,
          .note = "chaos on the way out: the step follows from rounding"}},
    };
    hn_figure_runs(f, &m, "pendulum from level", runs, 3);
    hn_model_close(&m);
}

// ---- an open start ----

enum { NV = 3, NC = 2 };

/// The assembled state of a four-bar moved off the constraints: phi = (gap, 0), J v = (rate, 0).
static void open_start(const hn_model *m, double gap, double rate, double *q, double *v) {
    hn_eval *e = NULL;
    hn_saddle_ws *ws = hn_saddle_ws_create(m->arena, NV, NC);
    const double zero[NV] = {0}, *M, *J;
    double step[NV], off[NC];
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_M | HN_TERM_J | HN_TERM_PHI, m->arena, &e),
                     HN_OK);
    M = hn_eval_get(e, HN_TERM_M);
    J = hn_eval_get(e, HN_TERM_J);
    memcpy(q, m->q, NV * sizeof *q);
    memcpy(v, m->v, NV * sizeof *v);
    for (int turn = 0; turn <= 5; turn++) {
        const int last = turn == 5;
        hn_eval_run(e, 0, q, v);
        memcpy(off, hn_eval_get(e, HN_TERM_PHI), sizeof off);
        if (last) {
            hn_mat_vec(NC, NV, J, v, off);
        }
        off[0] -= last ? rate : gap;
        assert_int_equal(hn_saddle_solve(NV, NC, M, J, zero, off, step, NULL, NULL, NULL, ws),
                         HN_OK);
        hn_axpy(NV, 1, step, last ? v : q);
    }
    hn_eval_free(e);
}

void hn_figures_open_start(hn_figures *f) {
    double q[NV], v[NV];
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    open_start(&m, 1e-4, 1e-3, q, v);
    static const hn_figure drift = {.what = "gap from phi = 1e-4 m, phi' = 1e-3 m/s [m]",
                                    .how = "fb0, index1@rk4:h=1e-3, 1 s",
                                    .printed = "1.10000005e-3",
                                    .units = 4,
                                    .note = "the last digit is the drift of RK4 itself"},
                           decay = {.what = "gap from phi = 1e-4 m, phi' = 1e-3 m/s [m]",
                                    .how = "fb0, baumgarte:alpha=10,beta=10@rk4:h=1e-3, 1 s",
                                    .printed = "9.535e-8"};
    hn_run *run = hn_motion_start_at(&m, "index1@rk4:h=1e-3", q, v);
    hn_figure_add(f, &drift, hn_motion_at(run, 1).gap);
    hn_run_free(run);
    run = hn_motion_start_at(&m, "baumgarte:alpha=10,beta=10@rk4:h=1e-3", q, v);
    hn_figure_add(f, &decay, hn_motion_at(run, 1).gap);
    hn_run_free(run);
    hn_model_close(&m);
}

// ---- alpha ----

#define BAUM(alpha, h) "baumgarte:alpha=" alpha ",beta=" alpha "@rk4:h=" h
#define ERROR_AT(alpha, h, figure)                                       \
    {                                                                    \
        BAUM(alpha, h), 10, HN_FIGURE_ERROR, {                           \
            .what = "largest error of an angle [rad]", .printed = figure \
        }                                                                \
    }
#define ROW_AT(alpha, h, figure)                             \
    {                                                        \
        BAUM(alpha, h), 10, HN_FIGURE_ROW, {                 \
            .what = "largest |phi_i| [m]", .printed = figure \
        }                                                    \
    }

static const hn_figure_run alphas[] = {
    ERROR_AT("0", "0.01", "2.3e-4"),
    ERROR_AT("1", "0.01", "1.0e-4"),
    ERROR_AT("5", "0.01", "7.4e-5"),
    ERROR_AT("20", "0.01", "3.1e-4"),
    ERROR_AT("50", "0.01", "9.8e-4"),
    ERROR_AT("100", "0.01", "5.2e-3"),
    {BAUM("200", "0.01"),
     10,
     HN_FIGURE_ERROR,
     {.what = "largest error of an angle [rad]",
      .printed = "4.1",
      .note = "the motion is lost; alpha h = 2 is within the limit of 2.785"}},
    {"projection@rk4:h=0.01",
     10,
     HN_FIGURE_ERROR,
     {.what = "largest error of an angle [rad]", .printed = "1.6e-5"}},
    ROW_AT("0", "0.01", "2.7e-4"),
    ROW_AT("1", "0.01", "6.5e-6"),
    ROW_AT("5", "0.01", "6.3e-7"),
    ROW_AT("20", "0.01", "3.4e-6"),
    ROW_AT("50", "0.01", "2.3e-5"),
    ROW_AT("100", "0.01", "1.2e-4"),
    ROW_AT("200", "0.01", "1.9e-3"),
    ERROR_AT("0", "0.0025", "9.2e-7"),
    ERROR_AT("1", "0.0025", "4.6e-7"),
    ERROR_AT("5", "0.0025", "3.5e-7"),
    ERROR_AT("20", "0.0025", "1.4e-6"),
    ERROR_AT("50", "0.0025", "4.1e-6"),
    ERROR_AT("100", "0.0025", "8.4e-6"),
    ERROR_AT("200", "0.0025", "1.9e-5"),
    {"projection@rk4:h=0.0025",
     10,
     HN_FIGURE_ERROR,
     {.what = "largest error of an angle [rad]", .printed = "1.2e-7"}},
    {BAUM("2650", "1e-3"),
     1,
     HN_FIGURE_ROW,
     {.what = "largest |phi_i| at alpha h = 2.65 [m]",
      .printed = "1.7e-4",
      .factor = 1.2,
      .note = "step and duration of the printed figure are not told"}},
};

/// rms and largest value of the largest rate over ten seconds.
static void rates(hn_figures *f, const hn_model *m) {
    double sum = 0, most = 0;
    int n = 0;
    hn_run *run = hn_motion_start(m, "projection@rk4:h=1e-3");
    for (; hn_run_time(run) < 10 - 1e-9; n++) {
        hn_sample s = {0};
        double largest = 0;
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
        for (int i = 0; i < m->info.n_user; i++) {
            largest = fmax(largest, fabs(s.v[i]));
        }
        sum += largest * largest;
        most = fmax(most, largest);
    }
    hn_run_free(run);
    hn_figure_put(f, "rms of the largest rate [rad/s]", "fb0, 10 s", "3.9", sqrt(sum / n));
    hn_figure_put(f, "largest rate [rad/s]", "fb0, 10 s", "9.7", most);
}

/// Orders where alpha follows the step: alpha = c h^-p.
static double order_with(const hn_model *m, const char *stepper, double c, double p) {
    enum { N = 5 };
    double h[N], error[N];
    for (int k = 0; k < N; k++) {
        char method[96];
        h[k] = ldexp(0.02, -k);
        const double alpha = c * pow(h[k], -p);
        (void)snprintf(method, sizeof method, "baumgarte:alpha=%.17g,beta=%.17g@%s:h=%.17g", alpha,
                       alpha, stepper, h[k]);
        error[k] = hn_figure_measure(m, method, 2, HN_FIGURE_ERROR);
    }
    return hn_fit_order(N, h, error);
}

void hn_figures_alpha(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_figure_runs(f, &m, "fb0", alphas, (int)(sizeof alphas / sizeof *alphas));
    const hn_figure_run lost = {
        BAUM("2760", "1e-3"),
        10,
        HN_FIGURE_STOP,
        {.what = "lost at alpha h = 2.76, below the limit [s]", .printed = "<10"}};
    hn_figure_runs(f, &m, "fb0", &lost, 1);
    rates(f, &m);
    hn_figure_put(f, "order of q with alpha = 1 / h", "fb0, baumgarte@rk4, 2 s", "2.2",
                  order_with(&m, "rk4", 1, 1));
    hn_figure_put(f, "order of q with alpha = 1.6 / h", "fb0, baumgarte@rk4, 2 s", "2.1",
                  order_with(&m, "rk4", 1.6, 1));
    hn_figure_put(f, "order of q with alpha = h^-1/2", "fb0, baumgarte@rk4, 2 s", "3.3",
                  order_with(&m, "rk4", 1, 0.5));
    static const hn_figure euler = {.what = "order of q with alpha = 1 / h",
                                    .how = "fb0, baumgarte@euler, 2 s",
                                    .printed = "1",
                                    .units = 0.2};
    hn_figure_add(f, &euler, order_with(&m, "euler", 1, 1));
    hn_model_close(&m);
}
