#include "support/near.h"

#include "base/arena.h"
#include "dynamics/ldl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_N = 24 };

static double random_unit(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 24) - 0.5;
}

/// A random saddle-point system with the pattern of a chain: speed i is coupled to i + 1, row k touches four speeds.
typedef struct chain {
    int nv, nc;
    hn_ex A[MAX_N * MAX_N], J[MAX_N * MAX_N], r1[MAX_N], r2[MAX_N], x[MAX_N], y[MAX_N],
        scratch[2 * MAX_N];
    int loop[MAX_N];
} chain;

static void fill_chain(hn_graph *g, chain *c, int loops, int massless) {
    c->nv = 2 * loops + 1;
    c->nc = 2 * loops;
    char name[32];
    memset(c->A, 0, sizeof c->A);
    memset(c->J, 0, sizeof c->J);
    for (int i = 0; i < c->nv; i++) {
        snprintf(name, sizeof name, "m%d", i);
        c->A[i * c->nv + i] = i == massless ? hn_num(0) : hn_symbol(g, name, NULL);
        if (i > 0 && i % 2 == 1 && i != massless && i - 1 != massless) {
            snprintf(name, sizeof name, "k%d", i);
            c->A[i * c->nv + i - 1] = c->A[(i - 1) * c->nv + i] = hn_symbol(g, name, NULL);
        }
        snprintf(name, sizeof name, "f%d", i);
        c->r1[i] = hn_symbol(g, name, NULL);
    }
    for (int k = 0; k < c->nc; k++) {
        const int first = k / 2 * 2;
        for (int j = first; j < first + 3; j++) {
            snprintf(name, sizeof name, "j%d_%d", k, j);
            c->J[k * c->nv + j] = hn_symbol(g, name, NULL);
        }
        snprintf(name, sizeof name, "g%d", k);
        c->r2[k] = hn_symbol(g, name, NULL);
        c->loop[k] = k / 2;
    }
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

/// max |A x - J' y - r1| and |J x - r2|
static double residual(hn_graph *g, const chain *c, const double *values) {
    double worst = 0, x[MAX_N], y[MAX_N];
    for (int i = 0; i < c->nv; i++) {
        x[i] = hn_graph_eval(g, c->x[i], values);
    }
    for (int k = 0; k < c->nc; k++) {
        y[k] = hn_graph_eval(g, c->y[k], values);
    }
    for (int i = 0; i < c->nv; i++) {
        double sum = -hn_graph_eval(g, c->r1[i], values);
        for (int j = 0; j < c->nv; j++) {
            sum += hn_graph_eval(g, c->A[i * c->nv + j], values) * x[j];
        }
        for (int k = 0; k < c->nc; k++) {
            sum -= hn_graph_eval(g, c->J[k * c->nv + i], values) * y[k];
        }
        worst = fmax(worst, fabs(sum));
    }
    for (int k = 0; k < c->nc; k++) {
        double sum = -hn_graph_eval(g, c->r2[k], values);
        for (int j = 0; j < c->nv; j++) {
            sum += hn_graph_eval(g, c->J[k * c->nv + j], values) * x[j];
        }
        worst = fmax(worst, fabs(sum));
    }
    return worst;
}

static void check_chain(int loops, int massless, int pairs) {
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    chain *c = calloc(1, sizeof *c);
    assert_non_null(c);
    fill_chain(g, c, loops, massless);
    hn_ldl f;
    const hn_ldl_input in = {c->nv, c->nc, c->A, c->J, pairs ? c->loop : NULL};
    assert_int_equal(hn_ldl_factor(g, &in, arena, &f), HN_OK);
    assert_true(f.available);
    hn_ldl_solve(g, &f, c->r1, c->r2, c->x, c->y, c->scratch);
    for (unsigned seed = 1; seed <= 5; seed++) {
        double *values = random_values(g, seed);
        assert_near(residual(g, c, values), 0, 1e-10); // pivots here are not below 1e-3
        free(values);
    }
    free(c);
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
    const hn_ex A[4] = {hn_num(1), hn_num(0), hn_num(0), hn_num(0)};
    hn_ldl f;
    const hn_ldl_input in = {2, 0, A, NULL, NULL};
    assert_int_equal(hn_ldl_factor(g, &in, arena, &f), HN_OK);
    assert_int_equal(f.available, 0);
    hn_arena_free(arena);
    hn_graph_free(g);
}

static void fill_grows_linearly_along_a_chain(void **state) {
    (void)state;
    int entries[2];
    for (int k = 0; k < 2; k++) {
        hn_graph *g = hn_graph_create();
        hn_arena *arena = hn_arena_create(0);
        chain *c = calloc(1, sizeof *c);
        fill_chain(g, c, k ? 10 : 5, -1);
        hn_ldl f;
        const hn_ldl_input in = {c->nv, c->nc, c->A, c->J, c->loop};
        assert_int_equal(hn_ldl_factor(g, &in, arena, &f), HN_OK);
        entries[k] = f.start[f.n];
        free(c);
        hn_arena_free(arena);
        hn_graph_free(g);
    }
    assert_true(entries[1] < 2.3 * entries[0]);
}

static void the_numeric_solve_follows_the_same_pattern(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_arena *arena = hn_arena_create(0);
    chain *c = calloc(1, sizeof *c);
    fill_chain(g, c, 4, -1);
    hn_ldl f;
    const hn_ldl_input in = {c->nv, c->nc, c->A, c->J, c->loop};
    assert_int_equal(hn_ldl_factor(g, &in, arena, &f), HN_OK);
    hn_ldl_solve(g, &f, c->r1, c->r2, c->x, c->y, c->scratch);
    double *values = random_values(g, 7);
    double *L = hn_arena_doubles(arena, (size_t)f.start[f.n]), inverse[3 * MAX_N], work[2 * MAX_N];
    for (int i = 0; i < f.start[f.n]; i++) {
        L[i] = hn_graph_eval(g, f.L[i], values);
    }
    for (int i = 0; i < 3 * f.n_blocks; i++) {
        inverse[i] = hn_graph_eval(g, f.inverse[i], values);
    }
    double r1[MAX_N], r2[MAX_N], x[MAX_N], y[MAX_N];
    for (int i = 0; i < c->nv; i++) {
        r1[i] = hn_graph_eval(g, c->r1[i], values);
    }
    for (int i = 0; i < c->nc; i++) {
        r2[i] = hn_graph_eval(g, c->r2[i], values);
    }
    hn_ldl_solve_numbers(&f, L, inverse, r1, r2, x, y, work);
    for (int i = 0; i < c->nv; i++) {
        assert_near(x[i], hn_graph_eval(g, c->x[i], values), 1e-10);
    }
    for (int i = 0; i < c->nc; i++) {
        assert_near(y[i], hn_graph_eval(g, c->y[i], values), 1e-10);
    }
    free(values);
    free(c);
    hn_arena_free(arena);
    hn_graph_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_of_loops_are_solved_by_single_and_double_pivots),
        cmocka_unit_test(a_speed_without_inertia_waits_for_a_multiplier),
        cmocka_unit_test(a_lone_speed_without_inertia_has_no_order),
        cmocka_unit_test(fill_grows_linearly_along_a_chain),
        cmocka_unit_test(the_numeric_solve_follows_the_same_pattern),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
