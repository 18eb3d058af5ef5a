// SPDX-License-Identifier: GPL-3.0-or-later
// Dense kernels against closed forms and against sums done another way.

#include "linalg/dense.h"
#include "support/alloc.h"
#include "support/near.h"

#include <float.h>
#include <math.h>

static void norm_survives_entries_whose_squares_overflow(void **state) {
    (void)state;
    const double big[2] = {3e300, -4e300}, tiny[2] = {3e-300, 4e-300}, bad[3] = {1, (double)NAN, 2};
    assert_rel(hn_norm2(2, big), 5e300, 4 * DBL_EPSILON);
    assert_rel(hn_norm2(2, tiny), 5e-300, 4 * DBL_EPSILON);
    assert_near(hn_norm2(0, NULL), 0, 0);
    assert_true(isnan(hn_norm2(3, bad)));
    assert_true(isnan(hn_norm_max(3, bad)));
}

static void products_with_a_matrix_and_its_transpose(void **state) {
    (void)state;
    const double A[6] = {1, 2, 3, 4, 5, 6}, x[3] = {1, 0, -1}, y[2] = {2, -1};
    double Ax[2], Aty[3];
    hn_mat_vec(2, 3, A, x, Ax);
    hn_mat_t_vec(2, 3, A, y, Aty);
    assert_all_near(Ax, ((double[]){-2, -2}), 2, 0);
    assert_all_near(Aty, ((double[]){-2, -1, 0}), 3, 0);
}

static void quadratic_form_reads_only_the_lower_triangle(void **state) {
    (void)state;
    double A[4] = {2, (double)NAN, 3, 5};
    const double x[2] = {1, 2}, y[2] = {-1, 4};
    assert_near(hn_quad_sym(2, A, x, y), 2 * -1 + 3 * (2 * -1 + 1 * 4) + 5 * 8, 1e-14);
    hn_mirror_lower(2, A);
    assert_near(A[1], 3, 0);
}

static void cholesky_of_the_hilbert_matrix_inverts_it(void **state) {
    (void)state;
    enum { N = 6 };
    double H[N * N], L[N * N], x[N], b[N];
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            H[i * N + j] = L[i * N + j] = 1.0 / (i + j + 1);
        }
        x[i] = i - 2.5;
    }
    hn_mat_vec(N, N, H, x, b);
    assert_int_equal(hn_cholesky(N, L, N, 0), HN_OK);
    hn_cholesky_solve(N, L, N, b);
    assert_all_near(b, x, N, 1e-9); // condition number 1.5e7
}

static void cholesky_tells_singular_from_indefinite(void **state) {
    (void)state;
    double singular[4] = {1, 0, 2, 4}, indefinite[4] = {1, 0, 2, 3}, nan[1] = {(double)NAN};
    assert_int_equal(hn_cholesky(2, singular, 2, 1e-14), HN_ERR_SINGULAR);
    assert_int_equal(hn_cholesky(2, indefinite, 2, 1e-14), HN_ERR_NOT_SPD);
    assert_int_equal(hn_cholesky(1, nan, 1, 0), HN_ERR_SINGULAR);
}

static void long_sum_keeps_what_plain_summation_loses(void **state) {
    (void)state;
    // (1 + 2^-30)^2 - 1 - 2^-29 = 2^-60 exactly
    double x = 1 + ldexp(1, -30);
    hn_sum2 sum = {0, 0};
    hn_sum2_add_product(&sum, x, x);
    hn_sum2_add(&sum, -1);
    hn_sum2_add(&sum, -ldexp(1, -29));
    assert_near(hn_sum2_value(&sum), ldexp(1, -60), 0);
    assert_true((x * x - 1) - ldexp(1, -29) == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(norm_survives_entries_whose_squares_overflow),
        cmocka_unit_test(products_with_a_matrix_and_its_transpose),
        cmocka_unit_test(quadratic_form_reads_only_the_lower_triangle),
        cmocka_unit_test(cholesky_of_the_hilbert_matrix_inverts_it),
        cmocka_unit_test(cholesky_tells_singular_from_indefinite),
        cmocka_unit_test(long_sum_keeps_what_plain_summation_loses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
