// SPDX-License-Identifier: GPL-3.0-or-later
// Collocation coefficients against the published ones, and the basis in which Newton's systems fall
// apart.
#include "integrators/implicit/implicit_tableau.h"
#include "support/near.h"

#include <math.h>

static hn_collocation radau5(void) {
    hn_collocation col;
    const double c[] = {(4 - sqrt(6)) / 10, (4 + sqrt(6)) / 10, 1};
    hn_collocation_init(&col, 3, 5, c);
    return col;
}

static hn_collocation gauss2(void) {
    hn_collocation col;
    const double c[] = {0.5 - sqrt(3) / 6, 0.5 + sqrt(3) / 6};
    hn_collocation_init(&col, 2, 4, c);
    return col;
}

// Hairer & Wanner 1996, table IV.5.6
static void radau_5_has_the_published_coefficients(void **state) {
    (void)state;
    const double r = sqrt(6);
    const double A[3][3] = {{(88 - 7 * r) / 360, (296 - 169 * r) / 1800, (-2 + 3 * r) / 225},
                            {(296 + 169 * r) / 1800, (88 + 7 * r) / 360, (-2 - 3 * r) / 225},
                            {(16 - r) / 36, (16 + r) / 36, 1.0 / 9}};
    const hn_collocation col = radau5();
    for (int i = 0; i < 3; i++) {
        assert_all_near(col.A[i], A[i], 3, 1e-15);
    }
    assert_all_near(col.b, A[2], 3, 1e-15);
    const double end[3] = {0, 0, 1};
    assert_all_near(col.end, end, 3, 0);
}

// 1 / gamma = (6 + 81^(1/3) - 9^(1/3)) / 30, see Hairer & Wanner 1996, IV.8
static void radau_5_splits_into_the_published_real_and_complex_numbers(void **state) {
    (void)state;
    const hn_collocation col = radau5();
    assert_int_equal(col.n_real, 1);
    assert_int_equal(col.n_pairs, 1);
    assert_near(1 / col.gamma, (6 + cbrt(81) - cbrt(9)) / 30, 1e-15);
}

static void check_split(const hn_collocation *col) {
    const int s = col->stages;
    double wanted[3][3] = {{0}}, found[3][3] = {{0}};
    int k = 0;
    if (col->n_real) {
        wanted[k][k] = col->gamma;
        k++;
    }
    if (col->n_pairs) {
        wanted[k][k] = wanted[k + 1][k + 1] = col->alpha;
        wanted[k][k + 1] = col->beta;
        wanted[k + 1][k] = -col->beta;
    }
    for (int i = 0; i < s; i++) {
        for (int j = 0; j < s; j++) {
            for (int a = 0; a < s; a++) {
                for (int b = 0; b < s; b++) {
                    found[i][j] += col->T_inverse[i][a] * col->A_inverse[a][b] * col->T[b][j];
                }
            }
        }
        assert_all_near(found[i], wanted[i], (size_t)s, 1e-13);
    }
}

static void the_basis_makes_the_inverse_fall_apart(void **state) {
    (void)state;
    hn_collocation col = radau5();
    check_split(&col);
    col = gauss2();
    check_split(&col);
    const double radau3[] = {1.0 / 3, 1}, one[] = {1};
    const double gauss3[] = {0.5 - sqrt(15) / 10, 0.5, 0.5 + sqrt(15) / 10};
    hn_collocation_init(&col, 2, 3, radau3);
    check_split(&col);
    hn_collocation_init(&col, 3, 6, gauss3);
    check_split(&col);
    hn_collocation_init(&col, 1, 1, one);
    check_split(&col);
}

// Hammer & Hollingsworth 1955
static void gauss_2_has_the_published_coefficients(void **state) {
    (void)state;
    const double r = sqrt(3) / 6;
    const double A[2][2] = {{0.25, 0.25 - r}, {0.25 + r, 0.25}}, b[2] = {0.5, 0.5};
    const double end[2] = {-sqrt(3), sqrt(3)};
    const hn_collocation col = gauss2();
    assert_all_near(col.A[0], A[0], 2, 1e-15);
    assert_all_near(col.A[1], A[1], 2, 1e-15);
    assert_all_near(col.b, b, 2, 1e-15);
    assert_all_near(col.end, end, 2, 1e-14);
}

// sum b c^(k-1) = 1/k up to the order
static void weights_integrate_polynomials_up_to_the_order(void **state) {
    (void)state;
    const hn_collocation methods[] = {radau5(), gauss2()};
    for (int m = 0; m < 2; m++) {
        const hn_collocation *col = &methods[m];
        for (int k = 1; k <= col->order + 1; k++) {
            double sum = 0;
            for (int i = 0; i < col->stages; i++) {
                sum += col->b[i] * pow(col->c[i], k - 1);
            }
            if (k <= col->order) {
                assert_near(sum, 1.0 / k, 1e-15);
            } else {
                assert_true(fabs(sum - 1.0 / k) > 1e-4);
            }
        }
    }
}

static void dense_weights_pass_through_the_start_and_the_stages(void **state) {
    (void)state;
    const hn_collocation col = radau5();
    double w[3];
    hn_collocation_dense(&col, 0, w);
    assert_near(fabs(w[0]) + fabs(w[1]) + fabs(w[2]), 0, 0);
    for (int i = 0; i < 3; i++) {
        hn_collocation_dense(&col, col.c[i], w);
        for (int j = 0; j < 3; j++) {
            assert_near(w[j], i == j, 1e-15);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radau_5_has_the_published_coefficients),
        cmocka_unit_test(radau_5_splits_into_the_published_real_and_complex_numbers),
        cmocka_unit_test(gauss_2_has_the_published_coefficients),
        cmocka_unit_test(the_basis_makes_the_inverse_fall_apart),
        cmocka_unit_test(weights_integrate_polynomials_up_to_the_order),
        cmocka_unit_test(dense_weights_pass_through_the_start_and_the_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
