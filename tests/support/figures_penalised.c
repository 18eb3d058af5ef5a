// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/dae.h"
#include "support/lagrangian_turns.h"
#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "integrators/list/stepper_list.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Penalty, augmented Lagrangian, and the trapezoidal rule on index 3 with and without its
// projections.

enum { NV = 3, NC = 2 };

#define PENALTY(a, gap, error)                                          \
    {"penalty:a=" a "@rk4:h=5e-4",                                      \
     1,                                                                 \
     HN_FIGURE_ROW_END,                                                 \
     {.what = "largest |phi_i| at the end [m]", .printed = gap}},       \
    {                                                                   \
        "penalty:a=" a "@rk4:h=5e-4", 1, HN_FIGURE_ERROR, {             \
            .what = "largest error of an angle [rad]", .printed = error \
        }                                                               \
    }

void hn_figures_penalty(hn_figures *f) {
    static const hn_figure_run runs[] = {PENALTY("1e3", "2.9e-5", "1.0e-4"),
                                         PENALTY("1e5", "2.9e-7", "1.0e-6"),
                                         PENALTY("1e7", "2.9e-9", "1.0e-8")};
    double s[2];
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_figure_runs(f, &m, "fb0", runs, (int)(sizeof runs / sizeof *runs));
    hn_turns_eigenvalues(&m, s);
    hn_figure_put(f, "factor of a turn, 1 / (1 + a s)", "fb0, augmented-lagrangian:a=10", "0.0838",
                  1 / (1 + 10 * s[0]));
    hn_figure_put(f, "factor of a turn, seen", "fb0, augmented-lagrangian:a=10", "0.08",
                  hn_turns_error(&m, 10, 8) / hn_turns_error(&m, 10, 7));
    hn_figure_put(f, "factor of a turn, 1 / (1 + a s)", "fb0, augmented-lagrangian:a=1e3", "9.1e-4",
                  1 / (1 + 1e3 * s[0]));
    hn_figure_put(f, "factor of a turn, seen", "fb0, augmented-lagrangian:a=1e3", "9e-4",
                  hn_turns_error(&m, 1e3, 3) / hn_turns_error(&m, 1e3, 2));
    static const hn_figure strong = {
        .what = "error that turns leave, a = 1e6 [rad/s^2]",
        .how = "fb0, augmented-lagrangian:a=1e6",
        .printed = "1e-9",
        .instead = "<1e-12",
        .note = "the solve of each turn is refined here, and loses no digits to the weight"};
    hn_figure_add(f, &strong, hn_turns_error(&m, 1e6, 6));
    hn_model_close(&m);
}

// ---- ALI3P ----

/// The scheme written down plainly: trapezoidal rule, tangent M + h^2/4 a J' J, projections, turns
/// until no angle moves by 1e-11, at most `most`. `early`: lambda* takes a phi of the old q before
/// the solve, which counts Newton's correction twice.
typedef struct plain_scheme {
    hn_eval *terms;
    double q[NV], v[NV], a[NV], lambda[NC];
    double T[NV * NV];
    long long turns;
    int lost;   ///< 1: the tangent is not definite any more
    double gap; ///< largest at the end of a step
} plain_scheme;

#define PLAIN_TOL 1e-11
enum { PLAIN_TERMS = HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_J | HN_TERM_GAMMA };

static void plain_tangent(plain_scheme *p, double h, double weight) {
    const double *M = hn_eval_get(p->terms, HN_TERM_M), *J = hn_eval_get(p->terms, HN_TERM_J);
    memcpy(p->T, M, sizeof p->T);
    for (int k = 0; k < NC; k++) {
        for (int i = 0; i < NV; i++) {
            hn_axpy(NV, h * h / 4 * weight * J[k * NV + i], J + (size_t)k * NV,
                    p->T + (size_t)i * NV);
        }
    }
    p->lost |= hn_cholesky(NV, p->T, NV, 0) != HN_OK;
}

/// One turn from q (changed); returns the largest change of an angle.
static double plain_turn(plain_scheme *p, double h, double weight, int early, const double *q0,
                         double *q) {
    double v1[NV], a1[NV], r[NV], push[NC];
    for (int i = 0; i < NV; i++) {
        v1[i] = 2 / h * (q[i] - q0[i]) - p->v[i];
        a1[i] = 4 / (h * h) * (q[i] - q0[i]) - 4 / h * p->v[i] - p->a[i];
    }
    hn_eval_run(p->terms, 0, q, v1);
    const double *f = hn_eval_get(p->terms, HN_TERM_F), *J = hn_eval_get(p->terms, HN_TERM_J),
                 *phi = hn_eval_get(p->terms, HN_TERM_PHI);
    for (int k = 0; k < NC; k++) {
        p->lambda[k] += early ? weight * phi[k] : 0;
        push[k] = p->lambda[k] + (early ? 0 : weight * phi[k]);
    }
    hn_mat_vec(NV, NV, hn_eval_get(p->terms, HN_TERM_M), a1, r);
    hn_axpy(NV, -1, f, r);
    for (int k = 0; k < NC; k++) {
        hn_axpy(NV, push[k], J + (size_t)k * NV, r);
    }
    for (int i = 0; i < NV; i++) {
        r[i] *= -h * h / 4;
    }
    plain_tangent(p, h, weight);
    hn_cholesky_solve(NV, p->T, NV, r);
    hn_axpy(NV, 1, r, q);
    if (!early) {
        hn_eval_run(p->terms, 0, q, v1);
        hn_axpy(NC, weight, hn_eval_get(p->terms, HN_TERM_PHI), p->lambda);
    }
    return hn_norm_max(NV, r);
}

static void plain_project(plain_scheme *p, double h, double weight, const double *given,
                          double *z) {
    double x[NV];
    const double *J = hn_eval_get(p->terms, HN_TERM_J);
    hn_mat_vec(NV, NV, hn_eval_get(p->terms, HN_TERM_M), z, x);
    for (int k = 0; given && k < NC; k++) {
        hn_axpy(NV, -h * h / 4 * weight * given[k], J + (size_t)k * NV, x);
    }
    plain_tangent(p, h, weight);
    hn_cholesky_solve(NV, p->T, NV, x);
    memcpy(z, x, sizeof x);
}

static void plain_step(plain_scheme *p, double h, double weight, int early, int most) {
    double q0[NV], a1[NV], v1[NV];
    memcpy(q0, p->q, sizeof q0);
    for (int i = 0; i < NV; i++) {
        p->q[i] += h * p->v[i] + h * h / 2 * p->a[i];
    }
    for (int turn = 1;; turn++) {
        p->turns++;
        if (plain_turn(p, h, weight, early, q0, p->q) < PLAIN_TOL || turn == most) {
            break;
        }
    }
    for (int i = 0; i < NV; i++) {
        v1[i] = 2 / h * (p->q[i] - q0[i]) - p->v[i];
        a1[i] = 4 / (h * h) * (p->q[i] - q0[i]) - 4 / h * p->v[i] - p->a[i];
    }
    hn_eval_run(p->terms, 0, p->q, v1);
    p->gap = fmax(p->gap, hn_norm2(NC, hn_eval_get(p->terms, HN_TERM_PHI)));
    plain_project(p, h, weight, NULL, v1);
    hn_eval_run(p->terms, 0, p->q, v1);
    plain_project(p, h, weight, hn_eval_get(p->terms, HN_TERM_GAMMA), a1);
    memcpy(p->v, v1, sizeof v1);
    memcpy(p->a, a1, sizeof a1);
}

/// Turns a step over one second; *gap (may be NULL): the largest at the end of a step.
static double plain_turns(const hn_model *m, double weight, int early, int most, double *gap) {
    plain_scheme p = {.turns = 0};
    const double h = 0.0025;
    const int n = 400;
    assert_int_equal(hn_eval_create(m->sys, PLAIN_TERMS, m->arena, &p.terms), HN_OK);
    memcpy(p.q, m->q, sizeof p.q);
    memcpy(p.v, m->v, sizeof p.v);
    memcpy(p.a, m->a, sizeof p.a);
    for (int k = 0; k < NC; k++) {
        p.lambda[k] = -m->lambda[k];
    }
    for (int i = 0; i < n && !p.lost; i++) {
        plain_step(&p, h, weight, early, most);
    }
    hn_eval_free(p.terms);
    if (gap) {
        *gap = p.gap;
    }
    return (double)p.turns / n;
}

static double raw_ratio(const hn_model *m, double t) {
    hn_test_dae d;
    hn_test_dae_open(&d, m, hn_stepper_find("trapezoidal"), HN_FORM_INDEX3, NULL);
    assert_int_equal(hn_test_dae_steps(&d, 0.02, (long long)(t / 0.02 + 0.5)), HN_OK);
    hn_test_dae_measure(&d);
    const double *raw = d.table->raw_lambda(d.self);
    const double ratio = hn_norm_max(NC, raw) / hn_norm_max(NC, d.lambda);
    hn_test_dae_close(&d);
    return ratio;
}

static const char another_stop[] =
    "turns end otherwise here: by the kinetic energy of the correction and the contraction seen";

static const hn_figure_run turns[] = {
    {"ali3p:weight=1e9@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_NEWTON,
     {.what = "turns a step", .printed = "2.7", .instead = "2.5", .note = another_stop}},
    {"ali3p:weight=1e7@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_NEWTON,
     {.what = "turns a step", .printed = "4.1", .instead = "5.5", .note = another_stop}},
    {"ali3p:weight=1e5@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_STOP,
     {.what = "a weight too small ends the run [s]", .printed = "<1"}},
    {"ali3p:weight=1e9@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_SPEED_END,
     {.what = "largest |(J v)_i| at the end [m/s]", .printed = "7e-8"}},
    {"ali3p:weight=1e7@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_SPEED_END,
     {.what = "largest |(J v)_i| at the end [m/s]",
      .printed = "7e-6",
      .units = 1,
      .note = "a single digit"}},
    {"ali3p@trapezoidal:h=0.0025",
     1,
     HN_FIGURE_ROW,
     {.what = "largest |phi_i| [m]", .printed = "1e-15", .units = 2}},
    {"index3@trapezoidal:h=0.02",
     1,
     HN_FIGURE_SPEED_END,
     {.what = "the same without projections [m/s]", .printed = "4e-3"}},
    {"index3@trapezoidal:h=0.02",
     2,
     HN_FIGURE_SPEED_END,
     {.what = "the same without projections [m/s]", .printed = "0.16"}},
    {"index3@trapezoidal:h=0.02",
     4,
     HN_FIGURE_STOP,
     {.what = "without projections the run ends [s]", .printed = "<4"}},
};

static void plain_figures(hn_figures *f, const hn_model *m) {
    double gap;
    hn_figure_put(f, "turns a step",
                  "fb0, the scheme written down plainly, weight 1e9, h = 0.0025, 1 s", "2.7",
                  plain_turns(m, 1e9, 0, 50, &gap));
    hn_figure_put(f, "turns a step",
                  "fb0, the scheme written down plainly, weight 1e7, h = 0.0025, 1 s", "4.1",
                  plain_turns(m, 1e7, 0, 50, &gap));
    (void)plain_turns(m, 1e7, 1, 20, &gap);
    hn_figure_put(f, "gap where Newton's correction counts twice [m]",
                  "fb0, the scheme written down plainly, at most 20 turns", ">1e-7", gap);
}

void hn_figures_turns(hn_figures *f) {
    static const hn_figure first = {.what = "multipliers of the scheme over the true ones",
                                    .how = "fb0, index3@trapezoidal:h=0.02, 1 s",
                                    .printed = "5"},
                           second = {.what = "multipliers of the scheme over the true ones",
                                     .how = "fb0, index3@trapezoidal:h=0.02, 2 s",
                                     .printed = "6e1",
                                     .factor = 1.15,
                                     .note = "growing by 10 a second of itself"},
                           order = {.what = "order of q",
                                    .how = "fb0, ali3p@trapezoidal, 1 s",
                                    .printed = "2.0"};
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_figure_runs(f, &m, "fb0", turns, (int)(sizeof turns / sizeof *turns));
    plain_figures(f, &m);
    hn_figure_add(f, &first, raw_ratio(&m, 1));
    hn_figure_add(f, &second, raw_ratio(&m, 2));
    hn_figure_add(f, &order, hn_figure_order(&m, "ali3p@trapezoidal:h=%h", 0.01, 4, 1));
    hn_model_close(&m);
}
