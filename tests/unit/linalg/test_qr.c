// SPDX-License-Identifier: GPL-3.0-or-later
// Pivoted QR: reconstruction, rank, least-norm solutions; and singular values against closed forms.

#include "linalg/dense.h"
#include "linalg/qr.h"
#include "linalg/svd.h"
#include "support/near.h"

#include <float.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

enum { MAX = 40 };

typedef struct fixture {
    hn_arena *arena;
    hn_qr qr;
    gsl_rng *rng;
} fixture;

static int setup(void **state) {
    static fixture f;
    f.arena = hn_arena_create(0);
    f.rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(f.rng, 7);
    *state = &f;
    return hn_qr_init(&f.qr, f.arena, MAX, MAX) ? 0 : -1;
}

static int teardown(void **state) {
    fixture *f = *state;
    gsl_rng_free(f->rng);
    hn_arena_free(f->arena);
    return 0;
}

static void fill_random(gsl_rng *rng, size_t n, double *x) {
    for (size_t i = 0; i < n; i++) {
        x[i] = 2 * gsl_rng_uniform(rng) - 1;
    }
}

/// m x n of rank r, column by column: a product of random factors
static void fill_of_rank(gsl_rng *rng, int m, int n, int r, double *a) {
    double left[MAX * MAX], right[MAX * MAX];
    fill_random(rng, (size_t)m * r, left);
    fill_random(rng, (size_t)n * r, right);
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < m; i++) {
            a[k * m + i] = hn_dot(r, left + i * r, right + k * r);
        }
    }
}

static void factors_multiply_back_and_show_the_rank(void **state) {
    fixture *f = *state;
    const int shapes[][3] = {{5, 3, 3},  {3, 5, 3}, {7, 7, 7}, {20, 12, 5},
                             {9, 30, 4}, {1, 1, 1}, {6, 4, 1}};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        int m = shapes[s][0], n = shapes[s][1], rank = shapes[s][2];
        double a[MAX * MAX];
        fill_of_rank(f->rng, m, n, rank, a);
        memcpy(f->qr.a, a, sizeof(double) * (size_t)m * n);
        hn_qr_factor(&f->qr, m, n, 1e-10);
        assert_int_equal(f->qr.rank, rank);
        for (int k = 0; k < n; k++) {
            double column[MAX] = {0};
            for (int i = 0; i < rank && i <= (k < rank ? k : rank - 1); i++) {
                column[i] = f->qr.a[k * m + i];
            }
            hn_qr_apply_q(&f->qr, column);
            assert_all_near(column, a + f->qr.perm[k] * m, m, 1e-13);
        }
    }
}

static void columns_of_zero_have_rank_zero(void **state) {
    fixture *f = *state;
    memset(f->qr.a, 0, sizeof(double) * 12);
    hn_qr_factor(&f->qr, 3, 4, 1e-10);
    assert_int_equal(f->qr.rank, 0);
    double x[3] = {1, 2, 3}, low = 1, high = 1;
    hn_qr_apply_q(&f->qr, x);
    assert_all_near(x, ((double[]){1, 2, 3}), 3, 0);
    hn_qr_sigma(&f->qr, &low, &high);
    assert_near(low + high, 0, 0);
    hn_qr_factor(&f->qr, 3, 0, 1e-10);
    assert_int_equal(f->qr.rank, 0);
}

static void least_norm_solution_meets_the_rows_and_is_orthogonal_to_the_kernel(void **state) {
    fixture *f = *state;
    enum { NV = 8, NC = 5, RANK = 3 };
    double rows[NC * NV], b[NC], x[NV], x0[NV], back[NC];
    fill_of_rank(f->rng, NV, NC, RANK, rows); // row i of J is column i of A
    fill_random(f->rng, NV, x0);
    hn_mat_vec(NC, NV, rows, x0, b); // consistent by construction
    memcpy(f->qr.a, rows, sizeof rows);
    hn_qr_factor(&f->qr, NV, NC, 1e-10);
    hn_qr_least_norm(&f->qr, b, x);
    hn_mat_vec(NC, NV, rows, x, back);
    assert_all_near(back, b, NC, 1e-13);

    // any other solution differs by a kernel vector, which x must not contain
    double kernel[NV];
    for (int i = 0; i < NV; i++) {
        kernel[i] = x0[i] - x[i];
    }
    assert_near(hn_dot(NV, kernel, x), 0, 1e-13);
    assert_true(hn_norm2(NV, x) < hn_norm2(NV, x0));
    double removed = hn_qr_remove_range(&f->qr, x0);
    assert_near(removed, hn_norm2(NV, x), 1e-13);
    assert_all_near(x0, kernel, NV, 1e-13);
}

static void triangular_solves_undo_each_other(void **state) {
    fixture *f = *state;
    fill_random(f->rng, 36, f->qr.a);
    hn_qr_factor(&f->qr, 6, 6, 0);
    double x[6] = {1, 2, 3, 4, 5, 6}, y[6];
    // R' R z = x, checked through R z and R' (R z)
    memcpy(y, x, sizeof y);
    hn_qr_solve_rt(&f->qr, y);
    for (int k = 0; k < 6; k++) {
        assert_near(hn_dot(k + 1, f->qr.a + k * 6, y), x[k], 1e-12);
    }
    hn_qr_solve_r(&f->qr, y);
    double r_y[6] = {0};
    for (int k = 0; k < 6; k++) {
        hn_axpy(k + 1, y[k], f->qr.a + k * 6, r_y);
    }
    for (int k = 0; k < 6; k++) {
        assert_near(hn_dot(k + 1, f->qr.a + k * 6, r_y), x[k], 1e-12);
    }
}

static void singular_values_of_a_rotation_scaled_by_known_numbers(void **state) {
    fixture *f = *state;
    // A = Q diag(5, 2, 1e-6) with Q the reflection I - 2 u u'
    const double u[3] = {1 / 3.0, 2 / 3.0, 2 / 3.0}, d[3] = {5, 2, 1e-6};
    double A[9], sigma[3], low, high;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            A[i * 3 + j] = ((i == j) - 2 * u[i] * u[j]) * d[j];
        }
    }
    assert_int_equal(hn_singular_values(3, 3, A, sigma, f->arena), HN_OK);
    for (int k = 0; k < 3; k++) {
        assert_near(sigma[k], d[k], 1e-14);
    }
    assert_rel(hn_condition_of(3, sigma), 5e6, 1e-8);
    assert_int_equal(hn_rank_of(3, sigma, 1e-5), 2);
    assert_int_equal(hn_rank_of(3, sigma, 1e-8), 3);

    memcpy(f->qr.a, A, sizeof A);
    hn_qr_factor(&f->qr, 3, 3, 0);
    hn_qr_sigma(&f->qr, &low, &high);
    assert_rel(high, 5, 1e-8);
    assert_rel(low, 1e-6, 1e-8);
}

static void singular_values_of_wide_and_tall_matrices_agree_and_nan_is_refused(void **state) {
    fixture *f = *state;
    double A[12], At[12], s1[3], s2[3];
    fill_random(f->rng, 12, A);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            At[j * 3 + i] = A[i * 4 + j];
        }
    }
    assert_int_equal(hn_singular_values(3, 4, A, s1, f->arena), HN_OK);
    assert_int_equal(hn_singular_values(4, 3, At, s2, f->arena), HN_OK);
    assert_all_near(s1, s2, 3, 1e-14);
    double frobenius = hn_norm2(12, A);
    assert_near(hn_norm2(3, s1), frobenius, 1e-14);

    A[5] = (double)NAN;
    hn_poison_fill(s1, 3);
    assert_int_equal(hn_singular_values(3, 4, A, s1, f->arena), HN_ERR_DIVERGED);
    assert_true(hn_poison_intact(s1, 3));
}

static void iterated_extremes_agree_with_the_singular_values(void **state) {
    fixture *f = *state;
    for (int trial = 0; trial < 20; trial++) {
        double A[12 * 9], sigma[9], low, high;
        fill_random(f->rng, 12 * 9, A);
        memcpy(f->qr.a, A, sizeof A);
        hn_qr_factor(&f->qr, 12, 9, 0);
        hn_qr_sigma(&f->qr, &low, &high);
        assert_int_equal(hn_singular_values(9, 12, A, sigma, f->arena), HN_OK);
        assert_rel(high, sigma[0], 0.01);
        assert_rel(low, sigma[8], 0.01);
    }
}

enum { CHAIN_M = 121, CHAIN_N = 80 };

// Rows of a long chain meet a few coordinates each, so that their Householder vectors are gone over
// entry by entry: the factors are those of the whole matrix all the same.
static void a_long_chain_multiplies_back(void **state) {
    fixture *f = *state;
    static double a[CHAIN_M * CHAIN_N];
    hn_qr qr;
    assert_true(hn_qr_init(&qr, f->arena, CHAIN_M, CHAIN_N));
    for (int k = 0; k < CHAIN_N; k++) {
        fill_random(f->rng, 3, a + k * CHAIN_M + k); // rows k .. k + 2
    }
    memcpy(qr.a, a, sizeof a);
    hn_qr_factor(&qr, CHAIN_M, CHAIN_N, 1e-10);
    assert_int_equal(qr.rank, CHAIN_N);

    // short vectors, in rising order and without zeros
    const int *rows, n = hn_qr_reflector(&qr, 0, &rows);
    assert_true(hn_qr_is_sparse(&qr, 0, n));
    for (int i = 0; i < n; i++) {
        assert_true(qr.a[rows[i]] != 0 && (i == 0 || rows[i] > rows[i - 1]));
    }

    // A P = Q R
    for (int k = 0; k < CHAIN_N; k++) {
        double column[CHAIN_M] = {0};
        memcpy(column, qr.a + (size_t)k * CHAIN_M, (size_t)(k + 1) * sizeof *column);
        hn_qr_apply_q(&qr, column);
        assert_all_near(column, a + qr.perm[k] * CHAIN_M, CHAIN_M, 1e-13);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(factors_multiply_back_and_show_the_rank, setup, teardown),
        cmocka_unit_test_setup_teardown(columns_of_zero_have_rank_zero, setup, teardown),
        cmocka_unit_test_setup_teardown(
            least_norm_solution_meets_the_rows_and_is_orthogonal_to_the_kernel, setup, teardown),
        cmocka_unit_test_setup_teardown(triangular_solves_undo_each_other, setup, teardown),
        cmocka_unit_test_setup_teardown(singular_values_of_a_rotation_scaled_by_known_numbers,
                                        setup, teardown),
        cmocka_unit_test_setup_teardown(
            singular_values_of_wide_and_tall_matrices_agree_and_nan_is_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(iterated_extremes_agree_with_the_singular_values, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(a_long_chain_multiplies_back, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
