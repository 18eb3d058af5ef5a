// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "dynamics/evaluate/block_lu.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { N_MAX = HN_BLOCK_LU_MOST, COLUMNS = 2 };

/// A square system with symbols for entries, and their values.
typedef struct system {
    hn_graph *g;
    int n;
    hn_ex A[N_MAX * N_MAX], B[N_MAX * COLUMNS], x[N_MAX * COLUMNS];
    double value[N_MAX * N_MAX], rhs[N_MAX * COLUMNS];
    double at[N_MAX * (N_MAX + COLUMNS)]; ///< by symbol
    hn_block_lu lu;
} system_at;

static double random_unit(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 24) - 0.5;
}

static hn_ex new_symbol(system_at *s, double value) {
    char name[32];
    const int k = hn_graph_n_symbols(s->g);
    snprintf(name, sizeof name, "x%d", k);
    s->at[k] = value;
    return hn_symbol(s->g, name, NULL);
}

/// `pattern` has n rows: '.' zero, 'x' a symbol, '1' the number one.
static void begin(system_at *s, int n, const char *const *pattern, unsigned seed) {
    memset(s, 0, sizeof *s);
    s->g = hn_graph_create();
    s->n = n;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const char kind = pattern[i][j];
            const double value = kind == 'x' ? random_unit(&seed) : kind == '1';
            s->value[i * n + j] = value;
            s->A[i * n + j] = kind == 'x' ? new_symbol(s, value) : hn_num(value);
        }
        for (int c = 0; c < COLUMNS; c++) {
            s->rhs[i * COLUMNS + c] = random_unit(&seed);
            s->B[i * COLUMNS + c] = new_symbol(s, s->rhs[i * COLUMNS + c]);
        }
    }
}

static void end(system_at *s) {
    hn_graph_free(s->g);
}

static double det_of(int n, const double *a) {
    double work[N_MAX * N_MAX], det = 1;
    memcpy(work, a, (size_t)n * (size_t)n * sizeof *a);
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k; i < n; i++) {
            best = fabs(work[i * n + k]) > fabs(work[best * n + k]) ? i : best;
        }
        for (int j = 0; j < n; j++) {
            const double keep = work[k * n + j];
            work[k * n + j] = work[best * n + j];
            work[best * n + j] = keep;
        }
        det *= best == k ? work[k * n + k] : -work[k * n + k];
        for (int i = k + 1; i < n; i++) {
            const double factor = work[i * n + k] / work[k * n + k];
            for (int j = k; j < n; j++) {
                work[i * n + j] -= factor * work[k * n + j];
            }
        }
    }
    return det;
}

/// Solves with the order planned, and checks A x = B and the determinant; rounding grows with the
/// condition, which is below 1e4 for these.
static void solve_and_check(system_at *s) {
    const int n = s->n;
    hn_ex A[N_MAX * N_MAX], B[N_MAX * COLUMNS];
    memcpy(A, s->A, sizeof A);
    memcpy(B, s->B, sizeof B);
    hn_block_lu_solve(s->g, &s->lu, A, B, COLUMNS, s->x);
    for (int i = 0; i < n; i++) {
        for (int c = 0; c < COLUMNS; c++) {
            double sum = 0;
            for (int j = 0; j < n; j++) {
                const double x = hn_graph_eval(s->g, s->x[j * COLUMNS + c], s->at);
                sum += s->value[i * n + j] * x;
            }
            assert_near(sum, s->rhs[i * COLUMNS + c], 1e-11);
        }
    }
    double det = s->lu.sign;
    for (int b = 0; b < s->lu.n_blocks; b++) {
        det *= hn_graph_eval(s->g, s->lu.pivot[b], s->at);
    }
    assert_rel(det, det_of(n, s->value), 1e-11);
}

static void systems_of_any_pattern_are_solved_and_the_pivots_give_the_determinant(void **state) {
    (void)state;
    static const char *const patterns[][6] = {
        {"x"},
        {"xx", "xx"},
        {".x", "xx"},
        {"xxx", "xxx", "1.x"},
        {"xx..", "xx..", "xxxx", "xxxx"},
        {"xxxxx", "xxxxx", "xxxxx", "xxxxx", "xxxxx"},
        {"xx1...", "xx.1..", "..xx..", "..xxx.", "x....x", "....xx"},
    };
    static const int sizes[] = {1, 2, 2, 3, 4, 5, 6};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        for (unsigned seed = 1; seed <= 5; seed++) {
            system_at s;
            begin(&s, sizes[k], patterns[k], seed);
            assert_true(hn_block_lu_plan(&s.lu, s.n, s.A, s.value));
            solve_and_check(&s);
            end(&s);
        }
    }
}

/// The two equations of a plane loop: either link may lie along an axis, where an entry vanishes.
static void a_pair_of_rows_is_solved_where_any_entry_vanishes(void **state) {
    (void)state;
    static const char *const pattern[] = {"xx", "xx"};
    for (int entry = 0; entry < 4; entry++) {
        system_at s;
        begin(&s, 2, pattern, 7);
        assert_true(hn_block_lu_plan(&s.lu, 2, s.A, s.value));
        assert_int_equal(s.lu.n_blocks, 1);
        s.value[entry] = s.at[hn_ex_symbol(s.g, s.A[entry])] = 0;
        solve_and_check(&s);
        end(&s);
    }
}

static void pivots_that_are_numbers_come_first_and_pairs_before_single_entries(void **state) {
    (void)state;
    static const char *const pattern[] = {"xxx", "xxx", "1.x"};
    system_at s;
    begin(&s, 3, pattern, 3);
    assert_true(hn_block_lu_plan(&s.lu, 3, s.A, s.value));
    assert_int_equal(s.lu.n_blocks, 2);
    assert_int_equal(s.lu.row[0], 2);
    assert_int_equal(s.lu.col[0], 0);
    assert_int_equal(s.lu.size[1], 2);
    end(&s);
}

static void a_singular_matrix_has_no_order(void **state) {
    (void)state;
    static const char *const patterns[][3] = {{"xx", "xx"}, {"xx", ".."}, {"x.x", "x.x", "xxx"}};
    static const int sizes[] = {2, 2, 3};
    for (int k = 0; k < 3; k++) {
        system_at s;
        begin(&s, sizes[k], patterns[k], 5);
        for (int j = 0; j < s.n; j++) { // the second row is twice the first one
            s.value[s.n + j] = 2 * s.value[j];
        }
        assert_false(hn_block_lu_plan(&s.lu, s.n, s.A, s.value));
        end(&s);
    }
}

static void rows_taken_in_order_solve_a_positive_definite_system(void **state) {
    (void)state;
    static const char *const pattern[] = {"xxx", "xxx", "xxx"};
    system_at s;
    begin(&s, 3, pattern, 11);
    for (int i = 0; i < 3; i++) { // its diagonal outweighs the rest of the row
        s.value[3 * i + i] = s.at[hn_ex_symbol(s.g, s.A[3 * i + i])] = 2;
    }
    hn_block_lu_plan_in_order(&s.lu, 3);
    solve_and_check(&s);
    end(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(systems_of_any_pattern_are_solved_and_the_pivots_give_the_determinant),
        cmocka_unit_test(a_pair_of_rows_is_solved_where_any_entry_vanishes),
        cmocka_unit_test(pivots_that_are_numbers_come_first_and_pairs_before_single_entries),
        cmocka_unit_test(a_singular_matrix_has_no_order),
        cmocka_unit_test(rows_taken_in_order_solve_a_positive_definite_system),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
