// SPDX-License-Identifier: GPL-3.0-or-later
// Newton matrices solve what they were filled with, dense or sparse, real or complex, at a cost
// that follows the entries.
#include "linalg/newton_matrix.h"

#include "linalg/compressed.h"
#include "linalg/row_check.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX = 400 };

// saddle of a chain: masses that touch their neighbours, a row between each two of them; `turn`
// changes values, not places
static void fill_chain(hn_newton_matrix *m, int links, double turn) {
    const int rows = links - 1;
    hn_newton_matrix_begin(m, links + rows);
    for (int i = 0; i < links; i++) {
        hn_newton_matrix_put(m, i, i, 1, turn);
        hn_newton_matrix_put(m, i, i, 1 + sin(i + turn), 0); // a place put twice is a sum
        if (i > 0) {
            hn_newton_matrix_put(m, i, i - 1, 0.3, 0.1 * turn);
            hn_newton_matrix_put(m, i - 1, i, -0.2, 0);
        }
    }
    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < 2; k++) {
            const double e = k == 0 ? 1 : -cos(0.2 * i + turn) - 1.5;
            hn_newton_matrix_put(m, i + k, links + i, -e, 0);
            hn_newton_matrix_put(m, links + i, i + k, e, 0.2 * k);
        }
    }
}

static void solve_chain(hn_newton_matrix *m, int parts, int links, double turn, double *x) {
    const int n = 2 * links - 1;
    for (int i = 0; i < parts * n; i++) {
        x[i] = cos(1.3 * i);
    }
    fill_chain(m, links, turn);
    assert_int_equal(hn_newton_matrix_factor(m), HN_OK);
    hn_newton_matrix_solve(m, x);
}

static void sparse_and_dense_solutions_are_the_same(void **state) {
    (void)state;
    const hn_number_field fields[] = {HN_REAL, HN_COMPLEX};
    const int links = 20, n = 2 * links - 1;
    hn_arena *arena = hn_arena_create(0);
    for (int f = 0; f < 2; f++) {
        hn_newton_matrix *sparse = hn_newton_matrix_create(arena, fields[f], 1, n, 10 * links);
        hn_newton_matrix *dense = hn_newton_matrix_create(arena, fields[f], 0, n, 0);
        // new values in the same places keep the pivots, another size gives them up
        for (int k = 0; k < 6; k++) {
            const int used = k == 3 ? links - 1 : links;
            double x[2 * MAX], y[2 * MAX];
            solve_chain(sparse, 1 + f, used, 0.3 * k, x);
            solve_chain(dense, 1 + f, used, 0.3 * k, y);
            for (int i = 0; i < (1 + f) * (2 * used - 1); i++) {
                assert_near(x[i], y[i], 1e-11 * (1 + fabs(y[i]))); // its condition is a few 1e3
            }
        }
        hn_newton_matrix_free(sparse);
    }
    hn_arena_free(arena);
}

static void a_pivot_that_dies_is_replaced(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_newton_matrix *m = hn_newton_matrix_create(arena, HN_REAL, 1, 3, 16);
    // full but for one place; the first pivot shrinks from 1 to 1e-14
    for (int k = 0; k < 2; k++) {
        const double small = k == 0 ? 1 : 1e-14, x0[] = {1, -2, 3};
        const double A[3][3] = {{small, 2, 1}, {3, 1, 0.5}, {0.25, 1, 4}};
        double b[3] = {0};
        hn_newton_matrix_begin(m, 3);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                hn_newton_matrix_put(m, i, j, A[i][j], 0);
                b[i] += A[i][j] * x0[j];
            }
        }
        assert_int_equal(hn_newton_matrix_factor(m), HN_OK);
        hn_newton_matrix_solve(m, b);
        for (int i = 0; i < 3; i++) {
            assert_near(b[i], x0[i], 1e-13); // keeping the pivot would cost all its digits
        }
    }
    hn_newton_matrix_free(m);
    hn_arena_free(arena);
}

static void dependent_rows_and_infinities_are_refused(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_newton_matrix *m = hn_newton_matrix_create(arena, HN_REAL, 1, 3, 9);
    const double twice[3][3] = {{1, 2, 0}, {2, 4, 0}, {0, 1, 1}};
    for (int bad = 0; bad < 2; bad++) {
        hn_newton_matrix_begin(m, 3);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                hn_newton_matrix_put(m, i, j, bad && i == j ? HUGE_VAL : twice[i][j], 0);
            }
        }
        assert_int_equal(hn_newton_matrix_factor(m), bad ? HN_ERR_DIVERGED : HN_ERR_SINGULAR);
    }
    // a row without entries
    hn_newton_matrix_begin(m, 2);
    hn_newton_matrix_put(m, 0, 0, 1, 0);
    hn_newton_matrix_put(m, 0, 1, 1, 0);
    assert_int_equal(hn_newton_matrix_factor(m), HN_ERR_SINGULAR);
    hn_newton_matrix_free(m);
    hn_arena_free(arena);
}

static void the_cost_of_a_chain_is_linear_in_its_links(void **state) {
    (void)state;
    double ops[2][2];
    hn_arena *arena = hn_arena_create(0);
    for (int long_one = 0; long_one < 2; long_one++) {
        const int links = long_one ? 200 : 20;
        for (int f = 0; f < 2; f++) {
            double x[2 * MAX];
            hn_newton_matrix *m = hn_newton_matrix_create(arena, f ? HN_COMPLEX : HN_REAL, 1,
                                                          2 * links - 1, 10 * links);
            solve_chain(m, 1 + f, links, 0.1, x);
            ops[long_one][f] = hn_newton_matrix_ops(m) / links;
            assert_true(hn_newton_matrix_nnz(m) < 14 * links);
            hn_newton_matrix_free(m);
        }
    }
    for (int f = 0; f < 2; f++) {
        assert_true(ops[1][f] < 1.2 * ops[0][f]); // the ends weigh less in a long chain
    }
    hn_arena_free(arena);
}

static void columns_rise_and_a_known_sequence_is_recognised(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_compressed c;
    double values[4];
    assert_int_equal(hn_compressed_init(&c, arena, 3, 4), 1);
    const int row[] = {2, 0, 1, 0}, col[] = {0, 2, 0, 2};
    for (int pass = 0; pass < 3; pass++) {
        hn_compressed_begin(&c, 3);
        for (int k = 0; k < 4; k++) {
            hn_compressed_put(&c, row[k], pass == 2 && k == 0 ? 1 : col[k], k + 1, 0);
        }
        assert_int_equal(hn_compressed_end(&c, 1, values), pass == 1);
        if (pass < 2) {
            const int start[] = {0, 2, 2, 3}, rows[] = {1, 2, 0};
            assert_memory_equal(c.start, start, sizeof start);
            assert_memory_equal(c.row, rows, sizeof rows);
            assert_near(values[0], 3, 0);
            assert_near(values[1], 1, 0);
            assert_near(values[2], 6, 0);
        }
    }
    // a filling that was broken off does not make the next one known
    hn_compressed_begin(&c, 3);
    hn_compressed_put(&c, 2, 2, 1, 0);
    for (int pass = 0; pass < 2; pass++) {
        hn_compressed_begin(&c, 3);
        hn_compressed_put(&c, 2, 2, 1, 0);
        assert_int_equal(hn_compressed_end(&c, 1, values), pass == 1);
    }
    hn_arena_free(arena);
}

// rows (e_i - e_(i+1)) of a chain stand on their own; with the one that joins its ends they do not
static void a_closing_row_that_follows_from_the_others_is_seen(void **state) {
    (void)state;
    enum { N = 30 };
    static double J[(N + 1) * (N + 1)];
    int row[2 * (N + 1)], col[2 * (N + 1)];
    hn_arena *arena = hn_arena_create(0);
    for (int closed = 0; closed < 2; closed++) {
        const int rows = N + closed;
        hn_row_check *check;
        memset(J, 0, sizeof J);
        for (int i = 0; i < rows; i++) {
            for (int k = 0; k < 2; k++) {
                row[2 * i + k] = i;
                col[2 * i + k] = (i + k) % (N + 1);
                J[i * (N + 1) + col[2 * i + k]] = k ? -7 : 7; // not of length one
            }
        }
        assert_int_equal(hn_row_check_create(arena, rows, N + 1, 2 * rows, row, col, &check),
                         HN_OK);
        assert_non_null(check);
        assert_int_equal(hn_row_check_run(check, J, NULL), !closed);
        assert_true(hn_row_check_ops(check) < 40 * N);
    }
    hn_arena_free(arena);
}

// Pairs [a 1; 1 0.5]: with a = 1 it may be the pivot, with a = 1e-6 it leaves ten digits. The
// pivots of before are not kept for that, although no entry grows beyond what is allowed.
static void pivots_that_have_become_poor_are_chosen_anew(void **state) {
    (void)state;
    enum { PAIRS = 20, SIZE = 2 * PAIRS };
    hn_arena *arena = hn_arena_create(0);
    hn_newton_matrix *m = hn_newton_matrix_create(arena, HN_REAL, true, SIZE, 4 * PAIRS);
    assert_non_null(m);
    for (int turn = 0; turn < 2; turn++) {
        const double a = turn == 0 ? 1 : 1e-6;
        double x[SIZE];
        hn_newton_matrix_begin(m, SIZE);
        for (int k = 0; k < PAIRS; k++) {
            hn_newton_matrix_put(m, 2 * k, 2 * k, a, 0);
            hn_newton_matrix_put(m, 2 * k, 2 * k + 1, 1, 0);
            hn_newton_matrix_put(m, 2 * k + 1, 2 * k, 1, 0);
            hn_newton_matrix_put(m, 2 * k + 1, 2 * k + 1, 0.5, 0);
            x[2 * k] = 0.3 * a + 0.7; // the solution is (0.3, 0.7)
            x[2 * k + 1] = 0.3 + 0.35;
        }
        assert_int_equal(hn_newton_matrix_factor(m), HN_OK);
        hn_newton_matrix_solve(m, x);
        for (int k = 0; k < PAIRS; k++) {
            assert_near(x[2 * k], 0.3, 1e-15);
            assert_near(x[2 * k + 1], 0.7, 1e-15);
        }
    }
    hn_newton_matrix_free(m);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pivots_that_have_become_poor_are_chosen_anew),
        cmocka_unit_test(sparse_and_dense_solutions_are_the_same),
        cmocka_unit_test(a_pivot_that_dies_is_replaced),
        cmocka_unit_test(dependent_rows_and_infinities_are_refused),
        cmocka_unit_test(the_cost_of_a_chain_is_linear_in_its_links),
        cmocka_unit_test(columns_rise_and_a_known_sequence_is_recognised),
        cmocka_unit_test(a_closing_row_that_follows_from_the_others_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
