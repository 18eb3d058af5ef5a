// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse factors of matrices that keep their pattern: against matrices built from known solutions,
// by their cost in entries, and where they have to refuse.

#include "linalg/dense.h"
#include "linalg/sparse_lu.h"
#include "linalg/sparse_spd.h"
#include "support/alloc.h"
#include "support/near.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

enum { MAX = 60, MAX_ENTRIES = MAX * MAX };

typedef struct matrix {
    int n, n_entries;
    int row[MAX_ENTRIES], col[MAX_ENTRIES];
    double value[MAX_ENTRIES];
} matrix;

static void put(matrix *m, int row, int col, double value) {
    m->row[m->n_entries] = row;
    m->col[m->n_entries] = col;
    m->value[m->n_entries++] = value;
}

static double uniform(gsl_rng *rng) {
    return 2 * gsl_rng_uniform(rng) - 1;
}

/// Each place filled with probability `density`, and a shuffled diagonal so that it can be regular.
static void fill_random(matrix *m, gsl_rng *rng, int n, double density) {
    *m = (matrix){.n = n};
    const int shift = n / 3;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const int kept = j == (i + shift) % n;
            if (kept || gsl_rng_uniform(rng) < density) {
                put(m, i, j, uniform(rng) + (kept ? 3 : 0));
            }
        }
    }
}

static void multiply(const matrix *m, const double *x, double *y) {
    memset(y, 0, (size_t)m->n * sizeof *y);
    for (int k = 0; k < m->n_entries; k++) {
        y[m->row[k]] += m->value[k] * x[m->col[k]];
    }
}

static void a_random_system_gives_back_the_solution_it_was_made_from(void **state) {
    (void)state;
    static matrix m;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, MAX, MAX_ENTRIES);
    for (int n = 1; n <= MAX; n += 7) {
        double x[MAX], b[MAX], found[MAX];
        fill_random(&m, rng, n, 0.1);
        hn_sparse_lu_set_pattern(lu, n, m.n_entries, m.row, m.col);
        // the second round keeps the order found for other values
        for (int round = 0; round < 2; round++) {
            for (int k = 0; round && k < m.n_entries; k++) {
                m.value[k] *= 1 + 0.2 * uniform(rng);
            }
            for (int i = 0; i < n; i++) {
                x[i] = uniform(rng);
            }
            multiply(&m, x, b);
            hn_poison_fill(found, MAX);
            assert_int_equal(hn_sparse_lu_factor(lu, m.value), HN_OK);
            hn_sparse_lu_solve(lu, b, found);
            assert_all_near(found, x, (size_t)n, 1e-11); // conditions of these are below 1e4
        }
    }
    hn_arena_free(arena);
    gsl_rng_free(rng);
}

static void the_determinant_of_a_permutation_is_its_sign(void **state) {
    (void)state;
    // (0 1 2)(3 4): even times odd; entries 2, so |det| = 32
    static const int row[] = {0, 1, 2, 3, 4}, col[] = {1, 2, 0, 4, 3};
    static const double value[] = {2, 2, 2, 2, 2}, turned[] = {2, -2, 2, 2, 2};
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, 5, 5);
    hn_sparse_lu_set_pattern(lu, 5, 5, row, col);
    assert_int_equal(hn_sparse_lu_factor(lu, value), HN_OK);
    assert_int_equal(hn_sparse_lu_sign(lu), -1);
    assert_near(hn_sparse_lu_log_volume(lu), 5 * log(2), 1e-14);
    assert_int_equal(hn_sparse_lu_factor(lu, turned), HN_OK);
    assert_int_equal(hn_sparse_lu_sign(lu), 1);
    assert_int_equal(hn_sparse_lu_nnz(lu), 5);
    hn_arena_free(arena);
}

static void an_order_that_became_bad_is_chosen_anew(void **state) {
    (void)state;
    // [a 1; 1 a]: good with pivot a at first, and with a = 1e-20 only by exchanging rows: the
    // solution is (1, 1)
    static const int row[] = {0, 0, 1, 1}, col[] = {0, 1, 0, 1};
    double value[] = {2, 1, 1, 2}, b[] = {3, 3};
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, 2, 4);
    hn_sparse_lu_set_pattern(lu, 2, 4, row, col);
    assert_int_equal(hn_sparse_lu_factor(lu, value), HN_OK);
    value[0] = value[3] = 1e-20;
    b[0] = b[1] = 1 + 1e-20;
    assert_int_equal(hn_sparse_lu_factor(lu, value), HN_OK);
    hn_sparse_lu_solve(lu, b, b);
    assert_near(b[0], 1, 1e-15);
    assert_near(b[1], 1, 1e-15);
    assert_int_equal(hn_sparse_lu_sign(lu), -1);
    hn_arena_free(arena);
}

/// The matrix of one loop in a plane has a form of its own: in every order, as its pivots change.
static void two_rows_are_solved_in_either_order_and_refused_without_a_pivot(void **state) {
    (void)state;
    static const int places[][4] = {{0, 1, 2, 3}, {3, 1, 0, 2}, {2, 3, 0, 1}, {1, 0, 3, 2}};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, 2, 4);
    for (int k = 0; k < 400; k++) {
        int row[4], col[4];
        double a[4], value[4];
        for (int i = 0; i < 4; i++) {
            // now and then an entry all but vanishes: the order that was chosen does not serve
            a[i] = (gsl_rng_uniform(rng) < 0.2 ? 1e-7 : 1) * uniform(rng);
        }
        for (int i = 0; i < 4; i++) {
            row[i] = places[k / 100][i] / 2;
            col[i] = places[k / 100][i] % 2;
            value[i] = a[places[k / 100][i]];
        }
        if (k % 100 == 0) {
            hn_sparse_lu_set_pattern(lu, 2, 4, row, col);
        }
        const double det = a[0] * a[3] - a[1] * a[2];
        double x[2] = {a[0] * 0.3 + a[1] * 0.7, a[2] * 0.3 + a[3] * 0.7};
        if (fabs(det) < 1e-9) { // as large as its products' rounding would not be told from nothing
            continue;
        }
        assert_int_equal(hn_sparse_lu_factor(lu, value), HN_OK);
        assert_int_equal(hn_sparse_lu_sign(lu), det > 0 ? 1 : -1);
        assert_near(hn_sparse_lu_log_volume(lu), log(fabs(det)), 1e-6);
        hn_sparse_lu_solve(lu, x, x);
        // cancellation in det costs 1e-16 / det; pivots may have grown by 10 (THRESHOLD)
        assert_near(x[0], 0.3, 1e-14 / fabs(det));
        assert_near(x[1], 0.7, 1e-14 / fabs(det));
    }

    // no pivot in any order
    const double flat[4] = {1, 2, 2, 4};
    hn_sparse_lu_set_pattern(lu, 2, 4, (const int[]){0, 0, 1, 1}, (const int[]){0, 1, 0, 1});
    assert_int_equal(hn_sparse_lu_factor(lu, flat), HN_ERR_SINGULAR);
    hn_arena_free(arena);
    gsl_rng_free(rng);
}

static void a_singular_matrix_is_refused_and_so_is_one_that_is_not_finite(void **state) {
    (void)state;
    static const int row[] = {0, 0, 1, 1}, col[] = {0, 1, 0, 1};
    static const double twice[] = {1, 2, 2, 4};
    const double broken[] = {1, 2, nan(""), 4};
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, 2, 4);
    hn_sparse_lu_set_pattern(lu, 2, 4, row, col);
    assert_int_equal(hn_sparse_lu_factor(lu, twice), HN_ERR_SINGULAR);
    assert_int_equal(hn_sparse_lu_factor(lu, broken), HN_ERR_DIVERGED);
    hn_arena_free(arena);
}

/// A chain of n blocks of two: each unknown meets its own block and the next one.
static void fill_chain(matrix *m, int n) {
    *m = (matrix){.n = 2 * n};
    for (int i = 0; i < 2 * n; i++) {
        for (int j = i - 3 > 0 ? i - 3 : 0; j <= i; j++) {
            put(m, i, j, i == j ? 10 : 1.0 / (1 + i + j));
        }
    }
}

static void a_chain_of_spd_blocks_costs_the_same_for_each_block(void **state) {
    (void)state;
    static matrix m;
    hn_arena *arena = hn_arena_create(0);
    double per_block[2];
    for (int k = 0; k < 2; k++) {
        const int n = k ? 30 : 10;
        double x[MAX], b[MAX];
        fill_chain(&m, n);
        hn_sparse_spd *spd = hn_sparse_spd_create(arena, m.n, m.n_entries, m.row, m.col);
        assert_non_null(spd);
        for (int i = 0; i < m.n; i++) {
            x[i] = 1 + 0.1 * i;
        }
        multiply(&m, x, b); // the lower half alone
        for (int e = 0; e < m.n_entries; e++) {
            b[m.col[e]] += m.row[e] != m.col[e] ? m.value[e] * x[m.row[e]] : 0;
        }
        assert_int_equal(hn_sparse_spd_factor(spd, m.value, 1e-12), HN_OK);
        hn_sparse_spd_solve(spd, b);
        assert_all_near(b, x, (size_t)m.n, 1e-14); // diagonally dominant
        per_block[k] = (hn_sparse_spd_factor_ops(spd) + hn_sparse_spd_solve_ops(spd)) / n;
    }
    assert_true(per_block[1] < 1.15 * per_block[0]);
    hn_arena_free(arena);
}

static void an_arrow_fills_in_nothing(void **state) {
    (void)state;
    // dense first row and column: eliminated first it would fill everything, minimum degree takes
    // it last
    static matrix m;
    const int n = 20;
    m = (matrix){.n = n};
    for (int i = 0; i < n; i++) {
        put(&m, i, i, i ? 1 : 100);
        if (i > 0) {
            put(&m, i, 0, 1);
        }
    }
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_spd *spd = hn_sparse_spd_create(arena, n, m.n_entries, m.row, m.col);
    assert_int_equal(hn_sparse_spd_nnz(spd), n - 1);
    assert_int_equal(hn_sparse_spd_factor(spd, m.value, 0), HN_OK);
    m.value[0] = n - 1; // the Schur complement of the corner is then zero
    assert_int_equal(hn_sparse_spd_factor(spd, m.value, 1e-14), HN_ERR_SINGULAR);
    hn_arena_free(arena);
}

static void factoring_and_solving_do_not_allocate(void **state) {
    (void)state;
    static matrix m;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    hn_arena *arena = hn_arena_create(0);
    hn_sparse_lu *lu = hn_sparse_lu_create(arena, MAX, MAX_ENTRIES);
    double b[MAX] = {1};
    fill_random(&m, rng, 40, 0.1);
    const long before = hn_alloc_count();
    hn_sparse_lu_set_pattern(lu, m.n, m.n_entries, m.row, m.col);
    assert_int_equal(hn_sparse_lu_factor(lu, m.value), HN_OK);
    hn_sparse_lu_solve(lu, b, b);
    assert_int_equal(hn_alloc_count(), before);
    hn_arena_free(arena);
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_random_system_gives_back_the_solution_it_was_made_from),
        cmocka_unit_test(the_determinant_of_a_permutation_is_its_sign),
        cmocka_unit_test(an_order_that_became_bad_is_chosen_anew),
        cmocka_unit_test(two_rows_are_solved_in_either_order_and_refused_without_a_pivot),
        cmocka_unit_test(a_singular_matrix_is_refused_and_so_is_one_that_is_not_finite),
        cmocka_unit_test(a_chain_of_spd_blocks_costs_the_same_for_each_block),
        cmocka_unit_test(an_arrow_fills_in_nothing),
        cmocka_unit_test(factoring_and_solving_do_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
