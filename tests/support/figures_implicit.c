// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/dae.h"
#include "support/near.h"

#include "dynamics/assembly/project.h"
#include "dynamics/evaluate/accel.h"
#include "integrators/implicit/implicit_linear.h"
#include "integrators/list/stepper_list.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Orders and condition of the implicit methods for the differential-algebraic forms; structural and
// half-explicit ones.

#define T_END 1.0

typedef struct order_row {
    const char *method, *integrator, *settings; ///< as told, and as stepped
    hn_dae_form form;
    int steps;
    const char *q, *v, *raw, *lambda; ///< NULL: not printed
} order_row;

static void put_order(hn_figures *f, const char *what, const char *method, const char *printed,
                      double found) {
    // slopes over four halvings
    const hn_figure row = {
        .what = what, .how = method, .printed = printed, .units = strchr(printed, '.') ? 3 : 0.3};
    if (printed) {
        hn_figure_add(f, &row, found);
    }
}

static void measure_orders(hn_figures *f, const hn_model *m, const char *scene,
                           const order_row *rows, int n) {
    hn_test_state end;
    hn_test_reference(m, T_END, &end);
    for (int i = 0; i < n; i++) {
        const order_row *r = &rows[i];
        char how[96];
        const hn_test_orders o = hn_test_dae_orders(m, hn_stepper_find(r->integrator), r->form,
                                                    r->settings, T_END, r->steps, 4, &end);
        (void)snprintf(how, sizeof how, "%s, %s, 1 s", scene, r->method);
        if (r->q) {
            put_order(f, "order of q", how, r->q, o.q);
        }
        if (r->v) {
            put_order(f, "order of v", how, r->v, o.v);
        }
        if (r->raw) {
            put_order(f, "order of the scheme's multipliers", how, r->raw, o.raw);
        }
        if (r->lambda) {
            put_order(f, "order of the multipliers recomputed", how, r->lambda, o.lambda);
        }
    }
}

void hn_figures_implicit_orders(hn_figures *f) {
    static const order_row rows[] = {
        {"index3@implicit-euler", "implicit-euler", NULL, HN_FORM_INDEX3, 200, "1", "1", "1", NULL},
        {"index2@implicit-euler", "implicit-euler", NULL, HN_FORM_INDEX2, 200, "1", "1", "1", NULL},
        {"ggl@implicit-euler", "implicit-euler", NULL, HN_FORM_GGL, 200, "1", "1", "1", NULL},
        {"index3@radau5", "radau5", "h=1", HN_FORM_INDEX3, 20, "4.8", "2.9", "2.0", NULL},
        {"index2@radau5", "radau5", "h=1", HN_FORM_INDEX2, 20, "5.0", "5.0", "2.9", "4.8"},
        {"ggl@radau5", "radau5", "h=1", HN_FORM_GGL, 20, "5", "5", "2.9", NULL},
        {"index2@midpoint", "midpoint", NULL, HN_FORM_INDEX2, 50, "2", "2", "1", NULL},
    };
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    measure_orders(f, &m, "fb0", rows, (int)(sizeof rows / sizeof *rows));
    hn_model_close(&m);
}

/// Largest error of the multipliers recomputed at the end, speeds projected.
static double recomputed_error(const hn_model *m, const char *form, const hn_test_state *end) {
    char method[96];
    double worst = 0;
    hn_run *run;
    (void)snprintf(method, sizeof method, "%s@radau5:h=0.0125", form);
    run = hn_motion_start(m, method);
    const hn_sample s = hn_motion_at(run, T_END);
    double v[3], a[3], lambda[2];
    hn_projector *projector = NULL;
    hn_accel *accel = NULL;
    const hn_accel_opts opts = {.want_lambda = 1};
    memcpy(v, s.v, sizeof v);
    assert_int_equal(hn_projector_create(m->sys, HN_WEIGHT_MASS, m->arena, &projector), HN_OK);
    assert_int_equal(hn_accel_create(m->sys, &opts, m->arena, &accel), HN_OK);
    assert_int_equal(hn_project_velocity(projector, T_END, s.q, v, NULL), HN_OK);
    assert_int_equal(hn_accel_eval(accel, T_END, s.q, v, 0, 0, a, lambda, NULL), HN_OK);
    for (int i = 0; i < 2; i++) {
        worst = fmax(worst, fabs(lambda[i] - end->lambda[i]));
    }
    hn_accel_free(accel);
    hn_projector_free(projector);
    hn_run_free(run);
    return worst;
}

void hn_figures_recomputed(hn_figures *f) {
    const hn_stepper *radau = hn_stepper_find("radau5");
    hn_model m;
    hn_test_state end;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_test_reference(&m, T_END, &end);
    const hn_test_orders two =
        hn_test_dae_orders(&m, radau, HN_FORM_INDEX2, "h=1", T_END, 80, 1, &end);
    const hn_test_orders three =
        hn_test_dae_orders(&m, radau, HN_FORM_INDEX3, "h=1", T_END, 80, 1, &end);
    hn_figure_put(f, "error of the scheme's multipliers [N]", "fb0, index2@radau5:h=0.0125, 1 s",
                  "3.7e-4", two.err_raw[0]);
    hn_figure_put(f, "error of the multipliers recomputed [N]", "fb0, index2@radau5:h=0.0125, 1 s",
                  "1.9e-8", two.err_lambda[0]);
    hn_figure_put(f, "error of the scheme's multipliers [N]", "fb0, index3@radau5:h=0.0125, 1 s",
                  "1.7e-2", three.err_raw[0]);
    hn_figure_put(f, "the same recomputed, speeds projected [N]",
                  "fb0, index3@radau5:h=0.0125, 1 s", "3.2e-8",
                  recomputed_error(&m, "index3", &end));
    hn_model_close(&m);
}

// ---- condition of Newton's matrix ----

enum { MAX_N = 32 };

typedef struct bench {
    hn_model model;
    hn_implicit_linear lin;
    int nv, nc;
} bench;

static void open_bench(bench *b, hn_dae_form form) {
    hn_model_open_closed(&b->model, "fb0-lagrangian", NULL);
    b->nv = b->model.info.nv;
    b->nc = b->model.info.nc;
    assert_int_equal(hn_implicit_linear_init(&b->lin, b->model.sys, form, b->model.arena), HN_OK);
    hn_implicit_linear_choose(&b->lin, 0, b->model.q, b->model.v);
    assert_int_equal(
        hn_implicit_linear_at(&b->lin, 0, b->model.q, b->model.v, b->model.a, b->model.lambda),
        HN_OK);
}

static double condition(const bench *b, int n, const double *A) {
    double sigma[MAX_N];
    assert_int_equal(hn_singular_values(n, n, A, sigma, b->model.arena), HN_OK);
    return hn_condition_of(n, sigma);
}

/// Residuals of implicit Euler's equations q1 - q0 - h v1, M (v1 - v0) - h (f + J' lambda), and phi
/// or J v. In (q, v, lambda) as they stand (s = 1), or with the unknowns (q, h v, h^2 lambda) and
/// the second row times h (s = h).
static double condition_of(const bench *b, double h, double s, int index) {
    const int nv = b->nv, nc = b->nc, n = 2 * nv + nc;
    double A[MAX_N * MAX_N] = {0};
    for (int i = 0; i < nv; i++) {
        A[i * n + i] = 1;
        A[i * n + nv + i] = -h / s;
        for (int j = 0; j < nv; j++) {
            A[(nv + i) * n + j] = s * h * b->lin.K[i * nv + j];
            A[(nv + i) * n + nv + j] = b->lin.M[i * nv + j] + h * b->lin.C[i * nv + j];
        }
        for (int k = 0; k < nc; k++) {
            A[(nv + i) * n + 2 * nv + k] = -h / s * b->lin.J[k * nv + i];
            A[(2 * nv + k) * n + (index == 3 ? i : nv + i)] = b->lin.J[k * nv + i];
        }
    }
    return condition(b, n, A);
}

void hn_figures_newton_matrix(hn_figures *f) {
    bench b;
    open_bench(&b, HN_FORM_INDEX3);
    static const hn_figure coarse = {.what = "condition, index 3 as it stands",
                                     .how = "fb0, implicit Euler, h = 1e-2",
                                     .printed = "6e4",
                                     .units = 1,
                                     .note = "a single digit, cut and not rounded"};
    hn_figure_add(f, &coarse, condition_of(&b, 1e-2, 1, 3));
    hn_figure_put(f, "condition, index 3 as it stands", "fb0, implicit Euler, h = 1e-5", "6e10",
                  condition_of(&b, 1e-5, 1, 3));
    hn_figure_put(f, "condition, index 2 as it stands", "fb0, implicit Euler, h = 1e-2", "6e2",
                  condition_of(&b, 1e-2, 1, 2));
    hn_figure_put(f, "condition, index 2 as it stands", "fb0, implicit Euler, h = 1e-5", "6e5",
                  condition_of(&b, 1e-5, 1, 2));
    hn_figure_put(f, "condition in (q, h v, h^2 lambda)", "fb0, implicit Euler, h = 1e-2", "12",
                  condition_of(&b, 1e-2, 1e-2, 3));
    hn_figure_put(f, "condition in (q, h v, h^2 lambda)", "fb0, implicit Euler, h = 1e-5", "12",
                  condition_of(&b, 1e-5, 1e-5, 3));
    hn_implicit_linear_free(&b.lin);
    hn_model_close(&b.model);
}

// ---- structural and half-explicit ----

void hn_figures_structural(hn_figures *f) {
    static const order_row rows[] = {
        {"index3@genalpha:rho=0.9", "genalpha", "rho=0.9", HN_FORM_INDEX3, 100, "2", "2", "2",
         NULL},
        {"index3@genalpha:rho=0.8", "genalpha", "rho=0.8", HN_FORM_INDEX3, 100, "2", "2", "2",
         NULL},
        {"index3@genalpha:rho=0", "genalpha", "rho=0", HN_FORM_INDEX3, 100, "2", "2", "2", NULL},
        {"index3@genalpha:rho=1", "genalpha", "rho=1", HN_FORM_INDEX3, 100, "2", "2", "0", NULL},
        {"index3@genalpha:a0=zero", "genalpha", "a0=zero", HN_FORM_INDEX3, 100, "1.0", "1.0", "1.0",
         NULL},
        {"index3@genalpha:a0=consistent", "genalpha", "a0=consistent", HN_FORM_INDEX3, 100, "2.0",
         "2.0", "2.0", NULL},
        {"ggl@genalpha", "genalpha", NULL, HN_FORM_GGL, 100, "2", "2", "2", NULL},
        {"index3@hht:damping=0.05", "hht", "damping=0.05", HN_FORM_INDEX3, 100, "1.1", "1.1", NULL,
         NULL},
        {"index3@hht:damping=0.3", "hht", "damping=0.3", HN_FORM_INDEX3, 100, "1.2", "1.2", NULL,
         NULL},
        {"index3@rattle", "rattle", NULL, HN_FORM_INDEX3, 100, "2", "2", "1", "2"},
    };
    static const order_row constant[] = {
        {"index3@hht:damping=0.05", "hht", "damping=0.05", HN_FORM_INDEX3, 100, "2.0", "2.0", NULL,
         NULL},
        {"index3@hht:damping=0.3", "hht", "damping=0.3", HN_FORM_INDEX3, 100, "2.0", "2.0", NULL,
         NULL},
    };
    hn_test_state end;
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    measure_orders(f, &m, "fb0", rows, (int)(sizeof rows / sizeof *rows));
    hn_test_reference(&m, T_END, &end);
    const hn_stepper *ga = hn_stepper_find("genalpha");
    const double
        zero = hn_test_dae_orders(&m, ga, HN_FORM_INDEX3, "a0=zero", T_END, 400, 1, &end).err_q[0],
        good = hn_test_dae_orders(&m, ga, HN_FORM_INDEX3, NULL, T_END, 400, 1, &end).err_q[0],
        one = hn_test_dae_orders(&m, ga, HN_FORM_INDEX3, "rho=1", T_END, 400, 1, &end).err_raw[0];
    hn_figure_put(f, "error with a0 = 0 over that with the right a0",
                  "fb0, index3@genalpha:h=2.5e-3, 1 s", "1.8e2", zero / good);
    hn_figure_put(f, "error of the scheme's multipliers at rho = 1 [N]",
                  "fb0, index3@genalpha:rho=1,h=2.5e-3, 1 s", "18", one);
    hn_model_close(&m);
    hn_model_open_text(&m, hn_figure_bob, NULL);
    measure_orders(f, &m, "pendulum from level", constant, 2);
    hn_model_close(&m);
}

void hn_figures_half_explicit(hn_figures *f) {
    static const order_row rows[] = {
        {"index2@hem3", "hem3", NULL, HN_FORM_INDEX2, 50, "3.0", NULL, NULL, NULL},
        {"index2@half-explicit-rk4", "half-explicit-rk4", NULL, HN_FORM_INDEX2, 50, "3.1", NULL,
         NULL, NULL},
        {"index2@hem4", "hem4", NULL, HN_FORM_INDEX2, 50, "4.0", "4.0", NULL, "4.0"},
    };
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    measure_orders(f, &m, "fb0", rows, 3);
    hn_model_close(&m);
}
