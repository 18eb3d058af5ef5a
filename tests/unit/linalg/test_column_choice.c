// SPDX-License-Identifier: GPL-3.0-or-later
// Columns by preference: against what is known to be independent, in what order they are taken, and
// what the part taken is worth.

#include "linalg/column_choice.h"
#include "linalg/svd.h"
#include "support/alloc.h"
#include "support/near.h"
#include "support/sparse_rows.h"

#include <gsl/gsl_rng.h>

enum { ROWS = 30, COLS = 45 };
static const double TOL = 1e-3;

static hn_column_choice *create(hn_arena *arena, const sparse_rows *m) {
    hn_column_choice *c = hn_column_choice_create(arena, ROWS, COLS, m->n, m->row, m->col);
    assert_non_null(c);
    return c;
}

/// A chain: each row has entries in five columns, of which the next row shares three or four.
static void fill_chain(sparse_rows *m) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    *m = (sparse_rows){.columns = COLS};
    for (int i = 0; i < ROWS; i++) {
        for (int j = i * (COLS - 5) / (ROWS - 1), k = 0; k < 5; k++) {
            put(m, i, j + k, 2 * gsl_rng_uniform(rng) - 1);
        }
    }
    gsl_rng_free(rng);
}

static void the_columns_taken_are_regular_whatever_the_order(void **state) {
    (void)state;
    static sparse_rows m;
    fill_chain(&m);
    hn_arena *arena = hn_arena_create(0);
    hn_column_choice *c = create(arena, &m);
    for (int turn = 0; turn < 3; turn++) { // from the first, from the last, mixed
        int order[COLS], taken[ROWS];
        double part[ROWS * ROWS], sigma[ROWS];
        for (int j = 0; j < COLS; j++) {
            order[j] = turn == 0 ? j : turn == 1 ? COLS - 1 - j : (7 * j) % COLS;
        }
        assert_int_equal(hn_column_choice_run(c, m.value, order, COLS, TOL, taken), ROWS);
        for (int i = 0; i < ROWS; i++) {
            for (int k = 0; k < ROWS; k++) {
                part[i * ROWS + k] = m.dense[i * COLS + taken[k]];
            }
        }
        assert_int_equal(hn_singular_values(ROWS, ROWS, part, sigma, arena), HN_OK);
        assert_int_equal(hn_rank_of(ROWS, sigma, 1e-12), ROWS);
        assert_int_equal(taken[0], order[0]);
    }
    hn_arena_free(arena);
}

static void a_column_that_follows_from_those_before_is_left_out(void **state) {
    (void)state;
    static sparse_rows m;
    m = (sparse_rows){.columns = COLS};
    for (int i = 0; i < ROWS; i++) {
        put(&m, i, i, 1 + i);
        if (i < 2) {
            put(&m, i, ROWS, 3); // in the span of columns 0 and 1
        }
    }
    hn_arena *arena = hn_arena_create(0);
    hn_column_choice *c = create(arena, &m);
    int order[COLS], taken[ROWS];
    order[0] = 1;
    order[1] = ROWS;
    order[2] = 0;
    for (int k = 3; k <= ROWS; k++) {
        order[k] = k - 1;
    }
    assert_int_equal(hn_column_choice_run(c, m.value, order, ROWS + 1, TOL, taken), ROWS);
    assert_int_equal(taken[1], ROWS); // column 0 is then the one that follows
    for (int k = 0; k < ROWS; k++) {
        assert_int_not_equal(taken[k], 0);
    }

    // an order without column 5 misses a row, and the next run starts afresh
    order[5] = 40;
    order[2] = 41;
    assert_int_equal(hn_column_choice_run(c, m.value, order, ROWS + 1, TOL, taken), ROWS - 1);
    hn_arena_free(arena);
}

static void choosing_does_not_allocate(void **state) {
    (void)state;
    static sparse_rows m;
    fill_chain(&m);
    hn_arena *arena = hn_arena_create(0);
    hn_column_choice *c = create(arena, &m);
    int order[COLS], taken[ROWS];
    for (int j = 0; j < COLS; j++) {
        order[j] = j;
    }
    const long before = hn_alloc_count();
    assert_int_equal(hn_column_choice_run(c, m.value, order, COLS, TOL, taken), ROWS);
    assert_int_equal(hn_alloc_count(), before);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_columns_taken_are_regular_whatever_the_order),
        cmocka_unit_test(a_column_that_follows_from_those_before_is_left_out),
        cmocka_unit_test(choosing_does_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
