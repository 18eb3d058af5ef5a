// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/arena.h"
#include "dynamics/evaluate/ldl.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_N = 24 };

static double random_unit(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 24) - 0.5;
}

/// A random saddle-point system with the pattern of a chain: speed i is coupled to i + 1, row k
/// touches four speeds.
typedef struct chain {
    int nv, nc;
    hn_entries W, J;
    hn_ex r[2 * MAX_N], x[2 * MAX_N]; ///< accelerations, then negative multipliers
} chain;

static hn_ex named(hn_graph *g, const char *letter, int i, int j) {
    char name[32];
    snprintf(name, sizeof name, "%s%d_%d", letter, i, j);
    return hn_symbol(g, name, NULL);
}

static void fill_chain(hn_graph *g, chain *c, int loops, int massless) {
    memset(c, 0, sizeof *c);
    c->nv = 2 * loops + 1;
    c->nc = 2 * loops;
    for (int i = 0; i < c->nv; i++) {
        if (i > 0 && i % 2 == 1 && i != massless && i - 1 != massless) {
            hn_entries_add(&c->W, i, i - 1, named(g, "k", i, i - 1));
        }
        if (i != massless) {
            hn_entries_add(&c->W, i, i, named(g, "m", i, i));
        }
        c->r[i] = named(g, "f", i, 0);
    }
    for (int k = 0; k < c->nc; k++) {
        const int first = k / 2 * 2;
        for (int j = first; j < first + 3; j++) {
            hn_entries_add(&c->J, k, j, named(g, "j", k, j));
        }
        c->r[c->nv + k] = named(g, "g", k, 0);
    }
}

static void reset_chain(chain *c) {
    hn_entries_reset(&c->W);
    hn_entries_reset(&c->J);
}

/// Values for all symbols: diagonals well above the rest.
static double *random_values(const hn_graph *g, unsigned seed) {
    double *x = calloc((size_t)hn_graph_n_symbols(g) + 1, sizeof *x);
    assert_non_null(x);
    for (int i = 0; i < hn_graph_n_symbols(g); i++) {
        x[i] = random_unit(&seed) + (hn_graph_symbol_name(g, i)[0] == 'm' ? 2.5 : 0);
    }
    return x;
}

/// max |K x - r|
static double residual(hn_graph *g, const chain *c, const double *values) {
    double x[2 * MAX_N], sum[2 * MAX_N], worst = 0;
    for (int i = 0; i < c->nv + c->nc; i++) {
        x[i] = hn_graph_eval(g, c->x[i], values);
        sum[i] = -hn_graph_eval(g, c->r[i], values);
    }
    for (int pass = 0; pass < 2; pass++) {
        const hn_entries *list = pass ? &c->J : &c->W;
        for (int k = 0; k < list->n; k++) {
            const int row = list->at[k].row + (pass ? c->nv : 0), col = list->at[k].col;
            const double e = hn_graph_eval(g, list->at[k].e, values);
            sum[row] += e * x[col];
            sum[col] += row == col ? 0 : e * x[row];
        }
    }
    for (int i = 0; i < c->nv + c->nc; i++) {
        worst = fmax(worst, fabs(sum[i]));
    }
    return worst;
}

static void check_chain(int loops, int massless, int pairs) {
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    chain c;
    fill_chain(g, &c, loops, massless);
    hn_ldl f;
    const hn_ldl_input in = {c.nv, c.nc, &c.W, &c.J, pairs};
    assert_int_equal(hn_ldl_build(g, &in, arena, &f), HN_OK);
    assert_true(f.available);
    assert_int_equal(f.n_blocks, pairs ? c.nv + loops : c.nv + c.nc);
    assert_int_equal(hn_ldl_solve(g, &f, c.r, c.x), HN_OK);
    for (unsigned seed = 1; seed <= 5; seed++) {
        double *values = random_values(g, seed);
        assert_near(residual(g, &c, values), 0, 1e-10); // pivots here are not below 1e-3
        free(values);
    }
    reset_chain(&c);
    hn_arena_free(arena);
    hn_graph_free(g);
}

static void chains_of_loops_are_solved_by_single_and_double_pivots(void **state) {
    (void)state;
    for (int loops = 1; loops <= 5; loops++) {
        check_chain(loops, -1, 0);
        check_chain(loops, -1, 1);
    }
}

static void a_speed_without_inertia_waits_for_a_multiplier(void **state) {
    (void)state;
    check_chain(1, 2, 0);
    check_chain(2, 4, 1);
}

static void a_lone_speed_without_inertia_has_no_order(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    hn_entries W = {0}, J = {0};
    hn_entries_add(&W, 0, 0, hn_num(1));
    hn_ldl f;
    const hn_ldl_input in = {2, 0, &W, &J, 0};
    assert_int_equal(hn_ldl_build(g, &in, arena, &f), HN_OK);
    assert_int_equal(f.available, 0);
    hn_entries_reset(&W);
    hn_arena_free(arena);
    hn_graph_free(g);
}

static void a_row_written_twice_has_no_order(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    for (int pairs = 0; pairs < 2; pairs++) {
        hn_entries W = {0}, J = {0};
        hn_entries_add(&W, 0, 0, hn_num(2));
        hn_entries_add(&J, 0, 0, hn_symbol(g, "j", NULL));
        hn_entries_add(&J, 1, 0, hn_symbol(g, "j", NULL));
        hn_ldl f;
        const hn_ldl_input in = {1, 2, &W, &J, pairs};
        assert_int_equal(hn_ldl_build(g, &in, arena, &f), HN_OK);
        assert_int_equal(f.available, 0);
        hn_entries_reset(&W);
        hn_entries_reset(&J);
    }
    hn_arena_free(arena);
    hn_graph_free(g);
}

static void fill_grows_linearly_along_a_chain(void **state) {
    (void)state;
    int entries[2];
    for (int k = 0; k < 2; k++) {
        hn_graph *g = hn_graph_create();
        hn_arena *arena = hn_arena_create(0);
        chain c;
        fill_chain(g, &c, k ? 10 : 5, -1);
        hn_ldl f;
        const hn_ldl_input in = {c.nv, c.nc, &c.W, &c.J, 0};
        assert_int_equal(hn_ldl_build(g, &in, arena, &f), HN_OK);
        entries[k] = f.nnz;
        reset_chain(&c);
        hn_arena_free(arena);
        hn_graph_free(g);
    }
    assert_true(entries[0] > 0 && entries[1] < 2.3 * entries[0]);
}

static void a_pivot_that_can_be_lost_is_guarded_by_what_it_came_from(void **state) {
    (void)state;
    // W = [a b; b c]: the second pivot is c - b^2/a and must be measured by c
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    hn_entries W = {0}, J = {0};
    hn_ex a = hn_num(4), b = hn_symbol(g, "b", NULL), c = hn_symbol(g, "c", NULL);
    hn_entries_add(&W, 0, 0, a);
    hn_entries_add(&W, 1, 0, b);
    hn_entries_add(&W, 1, 1, c);
    hn_ldl f;
    const hn_ldl_input in = {2, 0, &W, &J, 0};
    assert_int_equal(hn_ldl_build(g, &in, arena, &f), HN_OK);
    assert_int_equal(f.n_guards, 1);
    const double values[2] = {2, 3};
    assert_near(hn_graph_eval(g, f.guard[0][0], values), 3 - 2.0 * 2.0 / 4, 1e-15);
    assert_near(hn_graph_eval(g, f.guard[0][1], values), 3, 0);
    hn_entries_reset(&W);
    hn_arena_free(arena);
    hn_graph_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_of_loops_are_solved_by_single_and_double_pivots),
        cmocka_unit_test(a_speed_without_inertia_waits_for_a_multiplier),
        cmocka_unit_test(a_lone_speed_without_inertia_has_no_order),
        cmocka_unit_test(fill_grows_linearly_along_a_chain),
        cmocka_unit_test(a_row_written_twice_has_no_order),
        cmocka_unit_test(a_pivot_that_can_be_lost_is_guarded_by_what_it_came_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
