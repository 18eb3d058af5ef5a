// SPDX-License-Identifier: GPL-3.0-or-later
// The linear systems of Newton's method on differential-algebraic forms: they are solved, and their
// condition does not depend on the step in the unknowns that are used.
#include "integrators/implicit/implicit_linear.h"
#include "integrators/implicit/implicit_linear_solve.h"

#include "linalg/dense.h"
#include "linalg/svd.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX = 32 };

static const hn_dae_form forms[] = {HN_FORM_INDEX3, HN_FORM_INDEX2, HN_FORM_GGL};

typedef struct bench {
    hn_model model;
    hn_implicit_linear lin;
    int nv, nc;
} bench;

static void open_bench(bench *b, const char *scene, hn_dae_form form) {
    hn_model_open_closed(&b->model, scene, NULL);
    b->nv = b->model.info.nv;
    b->nc = b->model.info.nc;
    assert_int_equal(hn_implicit_linear_init(&b->lin, b->model.sys, form, b->model.arena), HN_OK);
    hn_implicit_linear_choose(&b->lin, 0, b->model.q, b->model.v);
    assert_int_equal(
        hn_implicit_linear_at(&b->lin, 0, b->model.q, b->model.v, b->model.a, b->model.lambda),
        HN_OK);
}

static void close_bench(bench *b) {
    hn_implicit_linear_free(&b->lin);
    hn_model_close(&b->model);
}

// A x of a real matrix on both parts, times (re, im), added to out with a sign
static void add_product(int rows, int cols, const double *A, double (*x)[MAX], double re, double im,
                        double (*out)[MAX]) {
    double y[2][MAX];
    for (int p = 0; p < 2; p++) {
        hn_mat_vec(rows, cols, A, x[p], y[p]);
    }
    for (int i = 0; i < rows; i++) {
        out[0][i] += re * y[0][i] - im * y[1][i];
        out[1][i] += im * y[0][i] + re * y[1][i];
    }
}

static void add_transposed(const bench *b, double (*l)[MAX], double sign, double (*out)[MAX]) {
    for (int p = 0; p < 2; p++) {
        double y[MAX];
        hn_mat_t_vec(b->nc, b->nv, b->lin.J, l[p], y);
        hn_axpy(b->nv, sign, y, out[p]);
    }
}

// largest entry of the left side of (1) plus r, for the solution (x, w, l, m) and the right side r
static double residual_of(const bench *b, hn_dae_form form, double re, double im,
                          double (*u)[4][MAX], double (*r)[4][MAX]) {
    double x[2][MAX], w[2][MAX], l[2][MAX], m[2][MAX], rows[2][MAX], worst = 0;
    double identity[MAX * MAX] = {0};
    const int nv = b->nv, nc = b->nc;
    for (int i = 0; i < nv; i++) {
        identity[i * nv + i] = 1;
    }
    for (int p = 0; p < 2; p++) {
        memcpy(x[p], u[p][0], sizeof x[p]);
        memcpy(w[p], u[p][1], sizeof w[p]);
        memcpy(l[p], u[p][2], sizeof l[p]);
        memcpy(m[p], u[p][3], sizeof m[p]);
    }
    for (int k = 0; k < 4; k++) {
        const int phi = form != HN_FORM_INDEX2;
        for (int p = 0; p < 2; p++) {
            memcpy(rows[p], r[p][k], sizeof rows[p]);
        }
        if (k == 0) {
            add_product(nv, nv, identity, x, re, im, rows);
            add_product(nv, nv, identity, w, -1, 0, rows);
            if (form == HN_FORM_GGL) {
                add_product(nv, nc, b->lin.Y, m, -1, 0, rows);
            }
        } else if (k == 1) {
            add_product(nv, nv, b->lin.M, w, re, im, rows);
            add_product(nv, nv, b->lin.K, x, 1, 0, rows);
            add_product(nv, nv, b->lin.C, w, 1, 0, rows);
            add_transposed(b, l, -1, rows);
        } else if (k == 2 && phi) {
            add_product(nc, nv, b->lin.J, x, 1, 0, rows);
        } else if (k == 2 || form == HN_FORM_GGL) {
            add_product(nc, nv, b->lin.V, x, 1, 0, rows);
            add_product(nc, nv, b->lin.J, w, 1, 0, rows);
        }
        const int used = k < 3 || form == HN_FORM_GGL;
        for (int i = 0; used && i < (k < 2 ? nv : nc); i++) {
            worst = fmax(worst, hypot(rows[0][i], rows[1][i]));
        }
    }
    return worst;
}

// car axis: damping is zero there, constraints move in time; squeezer: stiff; slider-crank: lengths
// and angles, damping
static void corrections_solve_the_linear_equations_of_every_form(void **state) {
    (void)state;
    static const char *const scenes[] = {"fb0", "andrews", "slider-crank", "five-bar"};
    for (int k = 0; k < 12; k++) {
        const hn_dae_form form = forms[k % 3];
        for (int parts = 1; parts <= 2; parts++) {
            const double re = 130, im = parts == 2 ? -70 : 0;
            bench b;
            double packed[2][4 * MAX], u[2][4][MAX] = {0}, r[2][4][MAX] = {0};
            open_bench(&b, scenes[k / 3], form);
            const int width[4] = {b.nv, b.nv, b.nc, form == HN_FORM_GGL ? b.nc : 0};
            for (int p = 0; p < parts; p++) {
                for (int at = 0, part = 0; part < 4; at += width[part++]) {
                    for (int i = 0; i < width[part]; i++) {
                        packed[p][at + i] = r[p][part][i] = sin(1 + p + 3.7 * (at + i));
                    }
                }
            }
            assert_int_equal(hn_implicit_linear_factor(&b.lin, parts - 1, re, im), HN_OK);
            hn_implicit_linear_solve(&b.lin, (hn_parts){parts, {packed[0], packed[1]}});
            double size = 1;
            for (int p = 0; p < parts; p++) {
                for (int at = 0, part = 0; part < 4; at += width[part++]) {
                    memcpy(u[p][part], packed[p] + at, (size_t)width[part] * sizeof(double));
                }
                size = fmax(size, hn_norm_max(2 * b.nv + b.nc, packed[p]));
            }
            assert_true(residual_of(&b, form, re, im, u, r) < 1e-11 * size);
            close_bench(&b);
        }
    }
}

static double condition(const bench *b, int n, const double *A) {
    double sigma[MAX];
    assert_int_equal(hn_singular_values(n, n, A, sigma, b->model.arena), HN_OK);
    return hn_condition_of(n, sigma);
}

// The Newton matrix of implicit Euler on index 3 in (q, v, lambda) as it stands
static double condition_unscaled(const bench *b, double h) {
    const int nv = b->nv, nc = b->nc, n = 2 * nv + nc;
    double A[MAX * MAX] = {0};
    assert_true(n <= MAX);
    for (int i = 0; i < nv; i++) {
        A[i * n + i] = 1 / h;
        A[i * n + nv + i] = -1;
        for (int j = 0; j < nv; j++) {
            A[(nv + i) * n + j] = b->lin.K[i * nv + j];
            A[(nv + i) * n + nv + j] = b->lin.M[i * nv + j] / h + b->lin.C[i * nv + j];
        }
        for (int k = 0; k < nc; k++) {
            A[(nv + i) * n + 2 * nv + k] = -b->lin.J[k * nv + i];
            A[(2 * nv + k) * n + i] = b->lin.J[k * nv + i];
        }
    }
    return condition(b, n, A);
}

// Bottasso, Dopico & Trainelli 2008
static void condition_grows_as_the_step_shrinks_unless_the_unknowns_are_scaled(void **state) {
    (void)state;
    bench b;
    double scaled[4], plain[4];
    open_bench(&b, "fb0-lagrangian", HN_FORM_INDEX3);
    for (int k = 0; k < 4; k++) {
        const double h = pow(10, -2 - k);
        double A[MAX * MAX];
        hn_implicit_linear_matrix(&b.lin, 1 / h, A);
        scaled[k] = condition(&b, b.nv + b.lin.n_kept, A);
        plain[k] = condition_unscaled(&b, h);
    }
    for (int k = 1; k < 4; k++) {
        assert_near(scaled[k], scaled[1], 0.05 * scaled[1]);
        assert_true(plain[k] > 50 * plain[k - 1]);
    }
    assert_true(scaled[0] < 20 && scaled[3] < 20);
    assert_true(plain[0] > 1e4 && plain[3] > 1e10);
    close_bench(&b);
}

static void dependent_rows_are_left_out(void **state) {
    (void)state;
    bench b;
    open_bench(&b, "fb0-redundant", HN_FORM_GGL);
    assert_int_equal(b.nc, 4);
    assert_int_equal(b.lin.n_kept, 2);
    assert_int_equal(hn_implicit_linear_factor(&b.lin, 0, 100, 0), HN_OK);
    assert_int_equal(hn_implicit_linear_factor(&b.lin, 1, 100, -50), HN_OK);
    close_bench(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corrections_solve_the_linear_equations_of_every_form),
        cmocka_unit_test(condition_grows_as_the_step_shrinks_unless_the_unknowns_are_scaled),
        cmocka_unit_test(dependent_rows_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
