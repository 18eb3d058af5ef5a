// SPDX-License-Identifier: GPL-3.0-or-later
// Products of sparse rows: least-norm and damped solutions and singular values against dense ones,
// rows that depend on each other, and where the rows meet too often.

#include "linalg/dense.h"
#include "linalg/gram.h"
#include "linalg/svd.h"
#include "support/alloc.h"
#include "support/near.h"
#include "support/sparse_rows.h"

#include <gsl/gsl_rng.h>
#include <string.h>

enum { ROWS = 24, COLS = 30 };

/// Each row meets its neighbours in two of its four columns.
static void fill_chain(sparse_rows *m) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    *m = (sparse_rows){.columns = COLS};
    for (int i = 0; i < ROWS; i++) {
        for (int j = i; j < i + 4; j++) {
            put(m, i, j, (j == i ? 2 : 0) + gsl_rng_uniform(rng));
        }
    }
    gsl_rng_free(rng);
}

static hn_gram *create(hn_arena *arena, const sparse_rows *m) {
    hn_gram *g;
    assert_int_equal(hn_gram_create(arena, ROWS, COLS, m->n, m->row, m->col, &g), HN_OK);
    assert_non_null(g);
    hn_gram_fill(g, m->value);
    return g;
}

static void solutions_are_those_of_the_dense_products(void **state) {
    (void)state;
    static sparse_rows m;
    fill_chain(&m);
    hn_arena *arena = hn_arena_create(0);
    hn_gram *g = create(arena, &m);
    const double shifts[] = {0, 0.3};
    for (int s = 0; s < 2; s++) {
        double b[ROWS], x[ROWS], back[ROWS], along[COLS];
        for (int i = 0; i < ROWS; i++) {
            b[i] = x[i] = 1 + 0.1 * i;
        }
        assert_int_equal(hn_gram_factor(g, shifts[s], 0), HN_OK);
        hn_gram_solve(g, x);

        // A (A' x) + shift x, by the dense A
        for (int j = 0; j < COLS; j++) {
            along[j] = 0;
            for (int i = 0; i < ROWS; i++) {
                along[j] += m.dense[i * COLS + j] * x[i];
            }
        }
        for (int i = 0; i < ROWS; i++) {
            back[i] = hn_dot(COLS, m.dense + i * COLS, along) + shifts[s] * x[i];
        }
        assert_all_near(back, b, ROWS, 1e-12); // the condition of these products is below 1e2

        double transposed[COLS], times[ROWS];
        hn_gram_times_transpose(g, x, transposed);
        hn_gram_times(g, transposed, times);
        assert_all_near(transposed, along, COLS, 1e-14);
        hn_axpy(ROWS, shifts[s], x, times);
        assert_all_near(times, b, ROWS, 1e-12);
    }
    hn_arena_free(arena);
}

static void singular_values_are_those_of_the_dense_matrix(void **state) {
    (void)state;
    static sparse_rows m;
    fill_chain(&m);
    hn_arena *arena = hn_arena_create(0);
    hn_gram *g = create(arena, &m);
    double sigma[ROWS], least, most;
    assert_int_equal(hn_singular_values(ROWS, COLS, m.dense, sigma, arena), HN_OK);
    assert_int_equal(hn_gram_factor(g, 0, 0), HN_OK);
    hn_gram_sigma(g, &least, &most);
    // 60 turns leave what lies within a few percent of the extreme value: to that spread
    assert_near(most / sigma[0], 1, 1e-3);
    assert_near(least / sigma[ROWS - 1], 1, 1e-3);
    hn_arena_free(arena);
}

static void a_row_that_is_the_sum_of_two_is_refused_and_damping_serves_it(void **state) {
    (void)state;
    static sparse_rows m;
    m = (sparse_rows){.columns = COLS};
    for (int i = 0; i < ROWS; i++) {
        for (int j = 0; j < COLS; j++) {
            if (i < ROWS - 1 && (j == i || j == i + 1)) {
                put(&m, i, j, 1);
            } else if (i == ROWS - 1 && j < 3) {
                put(&m, i, j, j == 1 ? 2 : 1); // row 0 and row 1
            }
        }
    }
    hn_arena *arena = hn_arena_create(0);
    hn_gram *g = create(arena, &m);
    assert_int_equal(hn_gram_factor(g, 0, 1e-10), HN_ERR_SINGULAR);
    assert_int_equal(hn_gram_factor(g, 1e-3, 0), HN_OK);
    assert_near(hn_gram_largest(g), 6, 0);
    hn_arena_free(arena);
}

static void columns_that_are_full_are_left_to_a_dense_way(void **state) {
    (void)state;
    enum { MANY = 400 };
    static int row[2 * MANY], col[2 * MANY];
    for (int i = 0; i < MANY; i++) { // all rows meet in column 0
        row[2 * i] = row[2 * i + 1] = i;
        col[2 * i + 1] = i + 1;
    }
    hn_arena *arena = hn_arena_create(0);
    hn_gram *g;
    assert_int_equal(hn_gram_create(arena, MANY, MANY + 1, 2 * MANY, row, col, &g), HN_OK);
    assert_null(g);
    hn_arena_free(arena);
}

static void filling_factoring_and_solving_do_not_allocate(void **state) {
    (void)state;
    static sparse_rows m;
    fill_chain(&m);
    hn_arena *arena = hn_arena_create(0);
    hn_gram *g = create(arena, &m);
    double x[ROWS] = {1};
    const long before = hn_alloc_count();
    hn_gram_fill(g, m.value);
    assert_int_equal(hn_gram_factor(g, 0, 0), HN_OK);
    hn_gram_solve(g, x);
    assert_int_equal(hn_alloc_count(), before);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_are_those_of_the_dense_products),
        cmocka_unit_test(singular_values_are_those_of_the_dense_matrix),
        cmocka_unit_test(a_row_that_is_the_sum_of_two_is_refused_and_damping_serves_it),
        cmocka_unit_test(columns_that_are_full_are_left_to_a_dense_way),
        cmocka_unit_test(filling_factoring_and_solving_do_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
