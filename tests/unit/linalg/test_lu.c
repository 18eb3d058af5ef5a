// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/lu.h"
#include "linalg/square.h"

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

/// The Newton matrix of a sound mechanism of masses `mass` and lengths 1: [M -J'; J 0] with three
/// velocities, two rows.
static void fill_newton(double mass, double A[25]) {
    static const double M[3][3] = {{2, 0.5, 0}, {0.5, 3, 1}, {0, 1, 4}};
    static const double J[2][3] = {{1, -0.5, 0.25}, {0.3, 0.8, -1}};
    memset(A, 0, 25 * sizeof *A);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            A[5 * i + j] = mass * M[i][j];
        }
        for (int r = 0; r < 2; r++) {
            A[5 * i + 3 + r] = -J[r][i];
            A[5 * (3 + r) + i] = J[r][i];
        }
    }
}

// masses of 1e-20 beside lengths of 1 leave a pivot of 1e-20 that nothing was subtracted from
static void light_masses_do_not_make_a_newton_matrix_singular(void **state) {
    (void)state;
    static const double masses[] = {1, 1e-8, 1e-14, 1e-20, 1e-30};
    for (int k = 0; k < 5; k++) {
        double A[25], B[25], scale[5], x[5] = {1, 2, 3, 4, 5}, y[5];
        hn_complex C[25], z[5];
        int pivot[5];
        hn_arena *arena = hn_arena_create(0);
        hn_square square;
        fill_newton(masses[k], A);
        memcpy(B, A, sizeof B);

        // right-hand sides of x = (1, 2, 3, 4 mass, 5 mass)
        x[3] *= masses[k];
        x[4] *= masses[k];
        for (int i = 0; i < 5; i++) {
            y[i] = 0;
            for (int j = 0; j < 5; j++) {
                y[i] += A[5 * i + j] * x[j];
            }
            z[i] = (hn_complex){y[i], 0};
        }
        for (int i = 0; i < 25; i++) {
            C[i] = (hn_complex){A[i], 0};
        }
        assert_int_equal(hn_square_init(&square, arena, 5), 1);
        memcpy(square.lu, A, sizeof A);
        assert_int_equal(hn_square_factor(&square, 5), HN_OK);
        assert_int_equal(hn_lu_factor(5, B, pivot, scale), HN_OK);
        assert_int_equal(hn_lu_factor_complex(5, C, pivot, scale), HN_OK);
        hn_lu_solve_complex(5, C, pivot, z);
        double w[5];
        memcpy(w, y, sizeof w);
        hn_square_solve(&square, w);
        for (int i = 0; i < 5; i++) {
            const double unit = i < 3 ? 1 : masses[k];
            assert_near(w[i] / unit, x[i] / unit, 1e-12);
            assert_near(z[i].re / unit, x[i] / unit, 1e-12);
        }
        hn_arena_free(arena);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_real_system_is_solved_whatever_the_units_of_its_rows),
        cmocka_unit_test(a_complex_system_is_solved),
        cmocka_unit_test(dependent_rows_and_infinities_are_refused),
        cmocka_unit_test(light_masses_do_not_make_a_newton_matrix_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
