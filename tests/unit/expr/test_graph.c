// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/graph.h"
#include "expr/tape.h"
#include "support/alloc.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 6 };

static void make_symbols(hn_graph *g, hn_ex x[N]) {
    char name[8] = "x0";
    for (int i = 0; i < N; i++) {
        name[1] = (char)('0' + i);
        x[i] = hn_symbol(g, name, NULL);
    }
}

static void equal_structure_is_one_node(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    assert_true(hn_ex_same(hn_symbol(g, "x0", NULL), x[0]));
    assert_true(hn_ex_same(hn_add(g, x[0], x[1]), hn_add(g, x[1], x[0])));
    assert_true(hn_ex_same(hn_mul(g, x[0], x[1]), hn_mul(g, x[1], x[0])));
    const hn_ex left = hn_mul(g, x[0], hn_mul(g, x[1], x[2]));
    assert_true(hn_ex_same(left, hn_mul(g, hn_mul(g, x[0], x[1]), x[2])));
    assert_true(
        hn_ex_same(hn_sin(g, hn_sub(g, x[0], x[1])), hn_neg(hn_sin(g, hn_sub(g, x[1], x[0])))));
    assert_true(hn_ex_same(hn_cos(g, hn_sub(g, x[0], x[1])), hn_cos(g, hn_sub(g, x[1], x[0]))));
    // a factor of a sum is outside of its node
    const hn_ex a = hn_add(g, hn_scale(2, x[0]), hn_scale(6, x[1]));
    const hn_ex b = hn_add(g, x[0], hn_scale(3, x[1]));
    assert_int_equal(a.n, b.n);
    hn_graph_free(g);
}

static void zeros_and_ones_vanish(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    assert_true(hn_is_zero(hn_sub(g, x[0], x[0])));
    assert_true(hn_is_zero(hn_mul(g, hn_num(0), hn_sin(g, x[0]))));
    assert_true(hn_ex_same(hn_mul(g, hn_num(1), x[0]), x[0]));
    assert_true(hn_ex_same(hn_add(g, x[0], hn_num(0)), x[0]));
    assert_true(hn_ex_same(hn_neg(hn_neg(x[0])), x[0]));
    assert_true(hn_ex_same(hn_div(g, x[0], x[0]), hn_num(1)));
    assert_true(hn_ex_same(hn_pow_int(g, x[0], 0), hn_num(1)));
    assert_true(hn_is_zero(hn_sin(g, hn_num(0))));
    assert_true(hn_ex_same(hn_cos(g, hn_num(0)), hn_num(1)));
    const hn_ex root = hn_sqrt(g, x[0]);
    assert_true(hn_ex_same(hn_mul(g, root, root), x[0]));
    double value;
    assert_true(hn_is_number(hn_mul(g, hn_num(3), hn_num(4)), &value));
    assert_near(value, 12, 0);
    hn_graph_free(g);
}

static void sine_and_cosine_squared_add_up_inside_a_sum(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    const hn_ex s = hn_sin(g, x[0]), c = hn_cos(g, x[0]), k = hn_mul(g, x[1], x[2]);
    const hn_ex ss = hn_mul(g, s, s), cc = hn_mul(g, c, c);
    assert_true(hn_ex_same(hn_add(g, ss, cc), hn_num(1)));
    assert_true(hn_ex_same(hn_add(g, hn_mul(g, k, ss), hn_mul(g, k, cc)), k));
    // other coefficients, or another argument: nothing to combine
    double number;
    assert_false(hn_is_number(hn_add(g, ss, hn_scale(2, cc)), &number));
    const hn_ex c1 = hn_cos(g, x[1]);
    assert_false(hn_is_number(hn_add(g, ss, hn_mul(g, c1, c1)), &number));
    hn_graph_free(g);
}

// c1 (c2 m) and c2 (c1 m) may differ in the last bit; their difference is still nothing
static void coefficients_cancel_relative_to_their_size(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    const double a = 0.1 * 3, b = 0.3;
    assert_true(a != b);
    assert_true(hn_is_zero(hn_sub(g, hn_scale(a, x[0]), hn_scale(b, x[0]))));
    assert_true(hn_is_zero(hn_sub(g, hn_scale(1e-30 * a, x[0]), hn_scale(1e-30 * b, x[0]))));
    assert_false(hn_is_zero(hn_sub(g, hn_scale(1 + 1e-9, x[0]), x[0])));
    hn_graph_free(g);
}

static void products_of_sums_are_never_expanded(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    hn_ex e = hn_num(1);
    const int before = hn_graph_size(g);
    for (int i = 0; i + 1 < N; i++) { // five factors of two terms would be 32 terms
        e = hn_mul(g, e, hn_add(g, x[i], x[i + 1]));
    }
    assert_true(hn_graph_size(g) - before <= 10);
    hn_graph_free(g);
}

/// Some expression of every typed operator with its argument kept inside the domain.
static hn_ex any_function(hn_graph *g, hn_op op, hn_ex a, hn_ex b) {
    const hn_ex small = hn_scale(0.4, hn_sin(g, a)), positive = hn_add(g, hn_num(2), hn_cos(g, b));
    hn_ex args[2] = {a, b};
    if (op == HN_OP_ASIN || op == HN_OP_ACOS) {
        args[0] = small;
    } else if (op == HN_OP_SQRT || op == HN_OP_LOG || op == HN_OP_POW || op == HN_OP_RECIP) {
        args[0] = positive;
    }
    return hn_apply(g, op, args);
}

// central differences of the values: an error of h^2 times the third derivative, some 1e-9 here
static void every_operator_has_its_derivative(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    make_symbols(g, x);
    const int symbols[2] = {0, 1};
    for (int op = HN_OP_MUL; op < HN_OP_COUNT; op++) {
        const hn_ex f = any_function(g, (hn_op)op, x[0], x[1]);
        hn_ex d[2], r[2];
        hn_diff(g, f, symbols, 2, d);
        hn_diff_reverse(g, f, symbols, 2, r);
        for (int k = 0; k < 4; k++) {
            double at[N] = {0.37 + 0.21 * k, 0.83 - 0.17 * k, 1, 1, 1, 1};
            for (int i = 0; i < 2; i++) {
                const double h = 1e-5, here = at[i];
                at[i] = here + h;
                const double up = hn_graph_eval(g, f, at);
                at[i] = here - h;
                const double down = hn_graph_eval(g, f, at);
                at[i] = here;
                const double expected = (up - down) / (2 * h);
                assert_near(hn_graph_eval(g, d[i], at), expected, 1e-7 * (1 + fabs(expected)));
                assert_near(hn_graph_eval(g, r[i], at), expected, 1e-7 * (1 + fabs(expected)));
            }
        }
    }
    hn_graph_free(g);
}

static unsigned next_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static hn_ex random_expression(hn_graph *g, const hn_ex x[N], unsigned *seed, int depth) {
    if (depth == 0) {
        return x[next_random(seed) % N];
    }
    const hn_ex a = random_expression(g, x, seed, depth - 1);
    const hn_ex b = random_expression(g, x, seed, depth - 1);
    switch (next_random(seed) % 5) {
    case 0:
        return hn_add(g, a, hn_scale(0.5, b));
    case 1:
        return hn_mul(g, a, b);
    case 2:
        return hn_sin(g, hn_sub(g, a, b));
    case 3:
        return hn_div(g, a, hn_add(g, hn_num(2), hn_mul(g, b, b)));
    default:
        return hn_sqrt(g, hn_add(g, hn_num(1), hn_mul(g, a, a)));
    }
}

// three routes to the same numbers: symbol by symbol, a gradient in one sweep, one direction in one
// sweep
static void forward_reverse_and_directional_derivatives_agree(void **state) {
    (void)state;
    const int symbols[N] = {0, 1, 2, 3, 4, 5};
    for (unsigned seed = 1; seed <= 60; seed++) {
        unsigned s = seed;
        hn_graph *g = hn_graph_create();
        hn_ex x[N], forward[N], reverse[N], along, direction[N];
        make_symbols(g, x);
        const hn_ex f = random_expression(g, x, &s, 5);
        double at[N], sum = 0;
        for (int i = 0; i < N; i++) {
            at[i] = 0.2 + 0.31 * i;
            direction[i] = hn_num(0.7 - 0.3 * i);
        }
        hn_diff(g, f, symbols, N, forward);
        hn_diff_reverse(g, f, symbols, N, reverse);
        hn_diff_forward(g, &f, 1, symbols, direction, N, &along);
        for (int i = 0; i < N; i++) {
            const double d = hn_graph_eval(g, forward[i], at);
            assert_near(hn_graph_eval(g, reverse[i], at), d, 1e-10 * (1 + fabs(d)));
            sum += d * (0.7 - 0.3 * i);
        }
        assert_near(hn_graph_eval(g, along, at), sum, 1e-9 * (1 + fabs(sum)));
        hn_graph_free(g);
    }
}

// Griewank's bound: the gradient costs a small multiple of the function, whatever the number of
// symbols
static void a_gradient_costs_a_few_times_the_function(void **state) {
    (void)state;
    enum { MANY = 200 };
    hn_graph *g = hn_graph_create();
    int symbols[MANY];
    hn_ex d[MANY], f = hn_num(1);
    char name[16];
    for (int i = 0; i < MANY; i++) {
        snprintf(name, sizeof name, "y%d", i);
        const hn_ex y = hn_symbol(g, name, NULL);
        symbols[i] = i;
        f = hn_sin(g, hn_add(g, hn_mul(g, f, y), hn_mul(g, y, y)));
    }
    const int function = hn_graph_size(g);
    hn_diff_reverse(g, f, symbols, MANY, d);
    assert_true(hn_graph_size(g) - function < 8 * function);
    hn_graph_free(g);
}

static void substitution_happens_all_at_once(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N], out;
    make_symbols(g, x);
    const hn_ex f = hn_sub(g, hn_sin(g, x[0]), hn_mul(g, x[1], x[1]));
    const int symbols[2] = {0, 1};
    const hn_ex swapped[2] = {x[1], x[0]};
    hn_substitute(g, &f, 1, symbols, swapped, 2, &out);
    assert_true(hn_ex_same(out, hn_sub(g, hn_sin(g, x[1]), hn_mul(g, x[0], x[0]))));
    assert_true(hn_depends_on(g, f, 0));
    assert_false(hn_depends_on(g, f, 2));
    hn_graph_free(g);
}

static void a_deep_graph_does_not_need_a_deep_stack(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N], e, d;
    make_symbols(g, x);
    e = x[0];
    for (int i = 0; i < 100000; i++) {
        e = hn_sin(g, hn_add(g, e, x[1]));
    }
    const int symbol = 0;
    hn_diff(g, e, &symbol, 1, &d);
    hn_diff_reverse(g, e, &symbol, 1, &d);
    const double at[N] = {0.1, 0.2, 0, 0, 0, 0};
    assert_true(isfinite(hn_graph_eval(g, d, at)));
    assert_true(hn_depends_on(g, e, 0));
    hn_graph_free(g);
}

static void out_of_memory_marks_the_graph(void **state) {
    (void)state;
    const long live = hn_alloc_live();
    int failures = 0;
    for (long n = 1; n < 500; n++) {
        hn_alloc_fail_at(n);
        hn_graph *g = hn_graph_create();
        if (g) {
            hn_ex x[N];
            unsigned seed = 3;
            make_symbols(g, x);
            const hn_ex f = random_expression(g, x, &seed, 9);
            (void)f;
        }
        const int hit = hn_alloc_has_failed();
        hn_alloc_fail_at(0);
        assert_true(!hit || !g || hn_graph_failed(g));
        failures += hit;
        hn_graph_free(g);
        assert_int_equal(hn_alloc_live(), live);
        if (!hit) {
            break;
        }
    }
    assert_true(failures >= 3);
}

/// Says yes from the k-th question on.
static bool ends_after(void *user) {
    return --*(int *)user < 0;
}

/// A nest of sines and products: some nodes for each of `n` levels.
static hn_ex make_nodes(hn_graph *g, const hn_ex x[N], int n) {
    hn_ex sum = hn_num(0);
    for (int i = 0; i < n; i++) {
        sum = hn_mul(g, x[i % 2], hn_add(g, hn_num(i + 1), hn_sin(g, sum)));
    }
    return sum;
}

static void an_interrupt_ends_building_and_compiling(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N];
    int left = 3;
    make_symbols(g, x);
    hn_graph_set_interrupt(g, (hn_interrupt){ends_after, &left});

    // a question for every so many nodes; the graph stops growing at the one that says yes
    make_nodes(g, x, 5000);
    assert_true(hn_graph_failed(g));
    assert_int_equal(hn_graph_status(g), HN_ERR_STOPPED);
    const int size = hn_graph_size(g);
    assert_in_range(size, 3 * 256, 4 * 256);
    make_nodes(g, x, 5000);
    assert_int_equal(hn_graph_size(g), size);
    hn_graph_free(g);

    // a tape of a graph that is there already asks too
    const int symbols[2] = {0, 1};
    hn_tape *tape = NULL;
    g = hn_graph_create();
    make_symbols(g, x);
    const hn_ex last = make_nodes(g, x, 5000);
    left = 3;
    hn_graph_set_interrupt(g, (hn_interrupt){ends_after, &left});
    assert_int_equal(hn_tape_compile(g, &last, 1, symbols, 2, &tape), HN_ERR_STOPPED);
    assert_null(tape);
    assert_int_equal(hn_graph_status(g), HN_ERR_STOPPED);
    hn_graph_free(g);

    // memory that runs out has its own status
    g = hn_graph_create();
    assert_int_equal(hn_graph_status(g), HN_OK);
    hn_graph_free(g);
}

/// The values at many points are those at each of them, bit by bit.
static void values_at_many_points_are_those_at_each(void **state) {
    (void)state;
    enum { POINTS = 5, STRIDE = 3 };
    double x[POINTS][STRIDE], all[POINTS];
    hn_graph *g = hn_graph_create();
    const hn_ex a = hn_symbol(g, "a", NULL);
    const hn_ex b = hn_symbol(g, "b", NULL);
    const hn_ex e = hn_scale(-0.3, hn_add(g, hn_mul(g, a, hn_sin(g, b)), hn_div(g, b, a)));
    for (int i = 0; i < POINTS * STRIDE; i++) {
        x[i / STRIDE][i % STRIDE] = 0.7 + 0.31 * i;
    }
    hn_graph_eval_all(g, e, x[0], POINTS, STRIDE, all);
    for (int i = 0; i < POINTS; i++) {
        assert_true(all[i] == hn_graph_eval(g, e, x[i]));
    }
    hn_graph_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_structure_is_one_node),
        cmocka_unit_test(zeros_and_ones_vanish),
        cmocka_unit_test(sine_and_cosine_squared_add_up_inside_a_sum),
        cmocka_unit_test(coefficients_cancel_relative_to_their_size),
        cmocka_unit_test(products_of_sums_are_never_expanded),
        cmocka_unit_test(every_operator_has_its_derivative),
        cmocka_unit_test(forward_reverse_and_directional_derivatives_agree),
        cmocka_unit_test(a_gradient_costs_a_few_times_the_function),
        cmocka_unit_test(substitution_happens_all_at_once),
        cmocka_unit_test(values_at_many_points_are_those_at_each),
        cmocka_unit_test(a_deep_graph_does_not_need_a_deep_stack),
        cmocka_unit_test(out_of_memory_marks_the_graph),
        cmocka_unit_test(an_interrupt_ends_building_and_compiling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
