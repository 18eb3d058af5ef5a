// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/lu.h"

#include "support/near.h"

#include <math.h>
#include <string.h>

enum { N = 6 };

static double next_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1 << 23) - 1;
}

static void a_real_system_is_solved_whatever_the_units_of_its_rows(void **state) {
    (void)state;
    unsigned seed = 3;
    double A[N * N], b[N], x[N], wanted[N], scale[N];
    int pivot[N];
    for (int i = 0; i < N; i++) {
        wanted[i] = next_random(&seed);
        for (int j = 0; j < N; j++) {
            A[i * N + j] = i == j ? 0 : next_random(&seed) * pow(10, 3 * i - 9);
        }
    }
    for (int i = 0; i < N; i++) {
        b[i] = 0;
        for (int j = 0; j < N; j++) {
            b[i] += A[i * N + j] * wanted[j];
        }
    }
    memcpy(x, b, sizeof x);
    assert_int_equal(hn_lu_factor(N, A, pivot, scale), HN_OK);
    hn_lu_solve(N, A, pivot, x);
    assert_all_near(x, wanted, N, 1e-13);
}

static void a_complex_system_is_solved(void **state) {
    (void)state;
    unsigned seed = 5;
    hn_complex A[N * N], b[N], wanted[N];
    double scale[N];
    int pivot[N];
    for (int i = 0; i < N; i++) {
        wanted[i] = (hn_complex){next_random(&seed), next_random(&seed)};
        for (int j = 0; j < N; j++) {
            A[i * N + j] = (hn_complex){i == j ? 0 : next_random(&seed), next_random(&seed)};
        }
    }
    for (int i = 0; i < N; i++) {
        b[i] = (hn_complex){0, 0};
        for (int j = 0; j < N; j++) {
            const hn_complex a = A[i * N + j];
            b[i].re += a.re * wanted[j].re - a.im * wanted[j].im;
            b[i].im += a.re * wanted[j].im + a.im * wanted[j].re;
        }
    }
    assert_int_equal(hn_lu_factor_complex(N, A, pivot, scale), HN_OK);
    hn_lu_solve_complex(N, A, pivot, b);
    assert_all_near(&b[0].re, &wanted[0].re, 2 * N, 1e-13);
}

static void dependent_rows_and_infinities_are_refused(void **state) {
    (void)state;
    double twice[4] = {1, 2, 1e6, 2e6}, broken[4] = {1, (double)INFINITY, 0, 1}, zero[4] = {1, 1};
    hn_complex dependent[4] = {{1, 1}, {2, 0}, {2, 2}, {4, 0}};
    double scale[2];
    int pivot[2];
    assert_int_equal(hn_lu_factor(2, twice, pivot, scale), HN_ERR_SINGULAR);
    assert_int_equal(hn_lu_factor(2, zero, pivot, scale), HN_ERR_SINGULAR);
    assert_int_equal(hn_lu_factor(2, broken, pivot, scale), HN_ERR_DIVERGED);
    assert_int_equal(hn_lu_factor_complex(2, dependent, pivot, scale), HN_ERR_SINGULAR);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_real_system_is_solved_whatever_the_units_of_its_rows),
        cmocka_unit_test(a_complex_system_is_solved),
        cmocka_unit_test(dependent_rows_and_infinities_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
