// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/strbuf.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/parse.h"
#include "expr/tape.h"
#include "expr/tape_interpret.h"
#include "expr/tape_long.h"
#include "support/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N_SYMBOLS = 5, N_POOL = 120 };

static unsigned next_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static double random_between(unsigned *seed, double low, double high) {
    return low + (high - low) * next_random(seed) / (double)(1u << 24);
}

static void make_symbols(hn_graph *g, hn_ex *x) {
    char name[8] = "x0";
    for (int i = 0; i < N_SYMBOLS; i++) {
        name[1] = (char)('0' + i);
        x[i] = hn_symbol(g, name, NULL);
    }
}

/// A pool of expressions that grow on one another, values kept moderate.
static void grow_pool(hn_graph *g, unsigned *seed, hn_ex pool[N_POOL]) {
    make_symbols(g, pool);
    for (int i = N_SYMBOLS; i < N_POOL; i++) {
        const hn_ex a = pool[next_random(seed) % (unsigned)i],
                    b = pool[next_random(seed) % (unsigned)i];
        const hn_ex k = hn_num(floor(random_between(seed, -4, 5)) / 2);
        switch (next_random(seed) % 9) {
        case 0:
            pool[i] = hn_add(g, a, b);
            break;
        case 1:
            pool[i] = hn_sub(g, hn_mul(g, k, a), b);
            break;
        case 2:
            pool[i] = hn_mul(g, hn_sin(g, a), b);
            break;
        case 3:
            pool[i] = hn_mul(g, hn_cos(g, b), hn_scale(-0.5, a));
            break;
        case 4:
            pool[i] = hn_div(g, a, hn_add(g, hn_num(2), hn_mul(g, b, b)));
            break;
        case 5:
            pool[i] = hn_sqrt(g, hn_add(g, hn_num(1), hn_mul(g, a, a)));
            break;
        case 6:
            pool[i] =
                hn_apply(g, HN_OP_ATAN2, (const hn_ex[]){a, hn_add(g, hn_num(1.5), hn_cos(g, b))});
            break;
        case 7:
            pool[i] = hn_add(g, hn_mul(g, hn_sin(g, a), hn_cos(g, b)), hn_mul(g, k, hn_sin(g, b)));
            break;
        default:
            pool[i] = hn_apply(g, HN_OP_TANH, (const hn_ex[]){hn_sub(g, a, hn_scale(2, b))});
            break;
        }
    }
}

static hn_tape *compile(hn_graph *g, const hn_ex *outputs, int n) {
    int symbols[N_SYMBOLS];
    for (int i = 0; i < N_SYMBOLS; i++) {
        symbols[i] = i;
    }
    hn_tape *tape = NULL;
    assert_int_equal(hn_tape_compile(g, outputs, n, symbols, N_SYMBOLS, &tape), HN_OK);
    return tape;
}

static double *workspace(const hn_tape *tape) {
    double *work = malloc((hn_tape_work_size(tape) + 1) * sizeof *work);
    assert_non_null(work);
    hn_poison_fill(work, hn_tape_work_size(tape));
    hn_tape_prepare(tape, work);
    return work;
}

// the graph evaluated node by node is the other path: no fusing, no slots, no scaling
static void random_graphs_agree_with_the_graph_itself(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 300; seed++) {
        unsigned s = seed;
        hn_graph *g = hn_graph_create();
        hn_ex pool[N_POOL];
        grow_pool(g, &s, pool);
        const int n = seed % 2 ? N_POOL : 7;
        hn_tape *tape = compile(g, pool + N_POOL - n, n);
        double *work = workspace(tape), x[N_SYMBOLS], out[N_POOL];
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < N_SYMBOLS; i++) {
                x[i] = random_between(&s, -2, 2);
            }
            hn_poison_fill(out, N_POOL);
            hn_tape_eval(tape, x, out, work);
            for (int i = 0; i < n; i++) {
                const double expected = hn_graph_eval(g, pool[N_POOL - n + i], x);
                // a hundred operations whose condition is moderate
                assert_near(out[i], expected, 1e-9 * (1 + fabs(expected)));
            }
        }
        free(work);
        hn_tape_free(tape);
        hn_graph_free(g);
    }
}

/// The pool's last n values in long double at x.
static void eval_long(const hn_tape *tape, const double *x, int n, long double *out) {
    long double *work = malloc((hn_tape_work_size(tape) + 1) * sizeof *work);
    assert_non_null(work);
    hn_tape_prepare_long(tape, work);
    for (int i = 0; i < N_SYMBOLS; i++) {
        work[i] = (long double)x[i];
    }
    hn_tape_run_long(tape, work);
    for (int i = 0; i < n; i++) {
        out[i] = work[hn_tape_output_slots(tape)[i]];
    }
    free(work);
}

// one operation of each kind on moderate numbers: the double is the rounded long double, to an
// operation's rounding or two
static void single_operations_in_long_double_round_to_the_double_ones(void **state) {
    (void)state;
    for (int op = HN_OP_MUL; op < HN_OP_COUNT; op++) {
        hn_graph *g = hn_graph_create();
        hn_ex x[N_SYMBOLS];
        make_symbols(g, x);
        const hn_ex out[1] = {hn_apply(g, (hn_op)op, x)};
        hn_tape *tape = compile(g, out, 1);
        double *work = workspace(tape), in[N_SYMBOLS], value;
        unsigned seed = 7;
        for (int k = 0; k < 50; k++) {
            long double precise;
            for (int i = 0; i < N_SYMBOLS; i++) {
                in[i] = random_between(&seed, 0.1, 0.9); // inside every domain
            }
            hn_tape_eval(tape, in, &value, work);
            eval_long(tape, in, 1, &precise);
            assert_rel(value, (double)precise, 5e-16);
        }
        free(work);
        hn_tape_free(tape);
        hn_graph_free(g);
    }
}

// sums of products of sines: no cancellation, so 1e-15 of the double is left
static void random_graphs_in_long_double_agree_with_double(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 100; seed++) {
        unsigned s = seed;
        hn_graph *g = hn_graph_create();
        hn_ex pool[N_POOL];
        grow_pool(g, &s, pool);
        hn_tape *tape = compile(g, pool, N_POOL);
        double *work = workspace(tape), x[N_SYMBOLS], out[N_POOL];
        long double precise[N_POOL];
        for (int i = 0; i < N_SYMBOLS; i++) {
            x[i] = random_between(&s, -2, 2);
        }
        hn_tape_eval(tape, x, out, work);
        eval_long(tape, x, N_POOL, precise);
        for (int i = 0; i < N_SYMBOLS + 5; i++) { // few operations: nothing is amplified yet
            assert_near(out[i], (double)precise[i], 1e-15 * (1 + fabs(out[i])));
        }
        for (int i = 0; i < N_POOL; i++) { // as against the graph itself
            assert_near(out[i], (double)precise[i], 1e-9 * (1 + fabs(out[i])));
        }
        free(work);
        hn_tape_free(tape);
        hn_graph_free(g);
    }
}

static int find_symbol(void *user, const char *name, hn_ex *out) {
    const hn_ex *x = user;
    if (name[0] != 'x' || name[1] < '0' || name[1] >= '0' + N_SYMBOLS) {
        return 0;
    }
    *out = x[name[1] - '0'];
    return 1;
}

// (sin^2 + cos^2 - 1) cancels to the rounding of the precision: the double leaves 1e-16, these
// leave 1e-19
static void closed_forms_hold_to_eighteen_digits(void **state) {
    (void)state;
    const char *const formulas[] = {
        "sin(x0)*sin(x0) + cos(x0)*cos(x0) - 1", // sine and cosine in one instruction
        "sin(2*x0) - 2*sin(x0)*cos(x0)",
        "sqrt(x1*x1) - x1",
        "exp(log(x1)) - x1",
        "tan(atan(x1)) - x1",
        "atan2(sin(x1), cos(x1)) - x1",
        "cosh(x1)*cosh(x1) - sinh(x1)*sinh(x1) - 1",
    };
    for (size_t k = 0; k < sizeof formulas / sizeof *formulas; k++) {
        hn_graph *g = hn_graph_create();
        hn_ex x[N_SYMBOLS], out[1];
        hn_diag diag = {0};
        make_symbols(g, x);
        const hn_parse_opts opts = {.lookup = find_symbol, .user = x};
        if (hn_parse(g, formulas[k], &opts, &out[0], &diag) != HN_OK) {
            fail_msg("%s", diag.message);
        }
        hn_tape *tape = compile(g, out, 1);
        const double in[N_SYMBOLS] = {0.7, 0.3, 0, 0, 0};
        long double value = 999;
        eval_long(tape, in, 1, &value);
        assert_true(value == 0 || fabsl(value) <= 1e-18L);
        hn_tape_free(tape);
        hn_graph_free(g);
    }
}

static void fewer_outputs_give_the_same_values_in_fewer_slots(void **state) {
    (void)state;
    unsigned s = 99;
    hn_graph *g = hn_graph_create();
    hn_ex pool[N_POOL];
    grow_pool(g, &s, pool);
    hn_tape *all = compile(g, pool, N_POOL), *last = compile(g, pool + N_POOL - 1, 1);
    double *work_all = workspace(all), *work_last = workspace(last), out[N_POOL], one;
    const double x[N_SYMBOLS] = {0.3, -1.1, 0.7, 1.9, -0.2};
    hn_tape_eval(all, x, out, work_all);
    hn_tape_eval(last, x, &one, work_last);
    assert_near(one, out[N_POOL - 1], 1e-12 * (1 + fabs(one)));
    assert_true(hn_tape_get_info(last).slots < hn_tape_get_info(all).slots);
    assert_true(hn_tape_get_info(last).ops < hn_tape_get_info(all).ops);
    free(work_all);
    free(work_last);
    hn_tape_free(all);
    hn_tape_free(last);
    hn_graph_free(g);
}

static void evaluation_allocates_nothing_and_repeats_to_the_bit(void **state) {
    (void)state;
    unsigned s = 5;
    hn_graph *g = hn_graph_create();
    hn_ex pool[N_POOL];
    grow_pool(g, &s, pool);
    hn_tape *tape = compile(g, pool, N_POOL);
    hn_graph_free(g); // a tape outlives its graph
    double *work = workspace(tape), first[N_POOL], second[N_POOL];
    const double x[N_SYMBOLS] = {0.3, -1.1, 0.7, 1.9, -0.2}, y[N_SYMBOLS] = {1, 2, -1, 0.5, 0};
    const long before = hn_alloc_count();
    hn_tape_eval(tape, x, first, work);
    hn_tape_eval(tape, y, second, work);
    hn_tape_eval(tape, x, second, work);
    assert_int_equal(hn_alloc_count(), before);
    assert_memory_equal(first, second, sizeof first);
    free(work);
    hn_tape_free(tape);
}

static void operations_are_counted_exactly(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N_SYMBOLS];
    make_symbols(g, x);
    // sin and cos of one argument, one product each, one sum: 1 + 2 + 1
    const hn_ex turn =
        hn_add(g, hn_mul(g, x[0], hn_cos(g, x[1])), hn_mul(g, x[2], hn_sin(g, x[1])));
    hn_tape *tape = compile(g, &turn, 1);
    hn_tape_info info = hn_tape_get_info(tape);
    assert_int_equal(info.sincos, 1);
    assert_int_equal(info.mul, 2);
    assert_int_equal(info.add, 1);
    assert_int_equal(info.ops, 4);
    assert_int_equal(info.instructions, 2);
    hn_tape_free(tape);
    // a quotient is one division, a difference one addition; a negated product inside a sum costs
    // no negation
    const hn_ex quotient = hn_sub(g, hn_div(g, x[0], x[1]), hn_mul(g, x[2], x[3]));
    tape = compile(g, &quotient, 1);
    info = hn_tape_get_info(tape);
    assert_int_equal(info.div, 1);
    assert_int_equal(info.mul, 1);
    assert_int_equal(info.add, 1);
    assert_int_equal(info.ops, 3);
    hn_tape_free(tape);
    // inputs and constants as outputs cost nothing
    const hn_ex plain[2] = {x[3], hn_num(2.5)};
    tape = compile(g, plain, 2);
    assert_int_equal(hn_tape_get_info(tape).ops, 0);
    double *work = workspace(tape), out[2];
    hn_tape_eval(tape, (const double[]){1, 2, 3, 4, 5}, out, work);
    assert_near(out[0], 4, 0);
    assert_near(out[1], 2.5, 0);
    free(work);
    hn_tape_free(tape);
    hn_graph_free(g);
}

static void a_listing_shows_what_runs(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N_SYMBOLS];
    make_symbols(g, x);
    const hn_ex e = hn_add(g, hn_mul(g, x[0], hn_cos(g, x[1])), hn_mul(g, x[2], hn_sin(g, x[1])));
    hn_tape *tape = compile(g, &e, 1);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_tape_list(tape, &b);
    assert_non_null(strstr(hn_strbuf_text(&b), "sincos a : in1"));
    assert_non_null(strstr(hn_strbuf_text(&b), "a * b + c * d :"));
    assert_non_null(strstr(hn_strbuf_text(&b), "out s"));
    hn_strbuf_reset(&b);
    hn_tape_free(tape);
    hn_graph_free(g);
}

static void a_chain_of_a_hundred_thousand_nodes_compiles_and_runs(void **state) {
    (void)state;
    hn_graph *g = hn_graph_create();
    hn_ex x[N_SYMBOLS];
    make_symbols(g, x);
    hn_ex e = x[0];
    for (int i = 0; i < 50000; i++) {
        e = hn_scale(0.5, hn_sin(g, hn_add(g, e, x[1])));
    }
    hn_tape *tape = compile(g, &e, 1);
    assert_true(hn_tape_get_info(tape).slots < 20); // a chain needs no more than its ends
    double *work = workspace(tape), out;
    hn_tape_eval(tape, (const double[]){0.3, 0.4, 0, 0, 0}, &out, work);
    double expected = 0.3;
    for (int i = 0; i < 50000; i++) {
        expected = 0.5 * sin(expected + 0.4);
    }
    assert_near(out, expected, 1e-14);
    free(work);
    hn_tape_free(tape);
    hn_graph_free(g);
}

static void equal_outputs_are_compiled_once_and_outlive_the_graph(void **state) {
    (void)state;
    unsigned s = 23;
    hn_graph *g = hn_graph_create();
    hn_ex pool[N_POOL];
    grow_pool(g, &s, pool);
    hn_tape *first = compile(g, pool, N_POOL);

    // the same question again takes one piece of memory: nothing is compiled
    const int symbols[N_SYMBOLS] = {0, 1, 2, 3, 4}, turned[N_SYMBOLS] = {4, 3, 2, 1, 0};
    hn_tape *again = NULL, *fewer = NULL, *swapped = NULL;
    const long before = hn_alloc_count();
    assert_int_equal(hn_tape_compile(g, pool, N_POOL, symbols, N_SYMBOLS, &again), HN_OK);
    assert_int_equal(hn_alloc_count(), before + 1);

    // other outputs or other inputs are another tape
    assert_int_equal(hn_tape_compile(g, pool, N_POOL - 1, symbols, N_SYMBOLS, &fewer), HN_OK);
    assert_int_equal(hn_tape_compile(g, pool, N_POOL, turned, N_SYMBOLS, &swapped), HN_OK);
    assert_int_equal(hn_tape_get_info(fewer).n_outputs, N_POOL - 1);

    // each lives as long as its owner wants
    hn_tape_free(first);
    hn_graph_free(g);
    const double in[N_SYMBOLS] = {0.3, -0.4, 0.5, 1.1, 0.7},
                 back[N_SYMBOLS] = {0.7, 1.1, 0.5, -0.4, 0.3};
    double out[N_POOL], other[N_POOL], *work = workspace(again), *work_2 = workspace(swapped);
    hn_tape_eval(again, in, out, work);
    hn_tape_eval(swapped, back, other, work_2);
    assert_memory_equal(out, other, sizeof out);
    free(work);
    free(work_2);
    hn_tape_free(again);
    hn_tape_free(fewer);
    hn_tape_free(swapped);
}

/// Fills the inputs of two workspaces with the same numbers.
static void fill_both(unsigned *s, double *x, double *y) {
    for (int i = 0; i < N_SYMBOLS; i++) {
        x[i] = y[i] = random_between(s, -20, 20);
    }
}

static void both_forms_of_the_interpreter_give_the_same_bits(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 200; seed++) {
        unsigned s = seed;
        hn_graph *g = hn_graph_create();
        hn_ex pool[N_POOL];
        grow_pool(g, &s, pool);
        hn_tape *tape = compile(g, pool, N_POOL);
        const size_t size = hn_tape_work_size(tape) * sizeof(double);
        double *x = workspace(tape), *y = workspace(tape);
        for (int k = 0; k < 3; k++) {
            fill_both(&s, x, y);
            hn_tape_interpret_by(HN_TAPE_JUMPS, tape, x);
            hn_tape_interpret_by(HN_TAPE_SWITCH, tape, y);
            assert_memory_equal(x, y, size);
        }
        free(x);
        free(y);
        hn_tape_free(tape);
        hn_graph_free(g);
    }
}

// which form is quicker is the processor's affair; that one is chosen, and that no value changes
// in the run that compares them, is not
static void the_forms_are_compared_after_a_while_and_values_stay(void **state) {
    (void)state;
    unsigned s = 23;
    hn_graph *g = hn_graph_create();
    hn_ex pool[N_POOL];
    grow_pool(g, &s, pool);
    hn_tape *tape = compile(g, pool, N_POOL);
    const int length = hn_tape_get_info(tape).instructions;
    const size_t size = hn_tape_work_size(tape) * sizeof(double);
    double *x = workspace(tape), *y = workspace(tape);
    hn_tape_dispatch serves;
    assert_true(length >= HN_TAPE_COMPARED_LENGTH);

    // each run beside one by jumps alone, past the one that compares
    for (int k = 0; k <= HN_TAPE_COMPARED_AFTER / length + 1; k++) {
        fill_both(&s, x, y);
        hn_tape_run(tape, x);
        hn_tape_interpret_by(HN_TAPE_JUMPS, tape, y);
        assert_memory_equal(x, y, size);
    }
    assert_true(hn_tape_is_compared(&serves));
    assert_true(serves == HN_TAPE_JUMPS || serves == HN_TAPE_SWITCH);
    free(x);
    free(y);
    hn_tape_free(tape);
    hn_graph_free(g);
}

static void out_of_memory_is_told_and_leaks_nothing(void **state) {
    (void)state;
    const int symbols[N_SYMBOLS] = {0, 1, 2, 3, 4};
    int failures = 0;
    for (long n = 1; n < 2000; n++) {
        unsigned s = 17;
        hn_ex pool[N_POOL];
        hn_tape *tape = NULL;
        const long live = hn_alloc_live();
        hn_graph *g = hn_graph_create();
        grow_pool(g, &s, pool);

        hn_alloc_fail_at(n);
        const hn_status status = hn_tape_compile(g, pool, N_POOL, symbols, N_SYMBOLS, &tape);
        const int hit = hn_alloc_has_failed();
        hn_alloc_fail_at(0);

        // what failed once can be asked for again
        assert_int_equal(status, hit ? HN_ERR_MEMORY : HN_OK);
        if (hit) {
            assert_int_equal(hn_tape_compile(g, pool, N_POOL, symbols, N_SYMBOLS, &tape), HN_OK);
            failures++;
        }
        hn_tape_free(tape);
        hn_graph_free(g);
        assert_int_equal(hn_alloc_live(), live);
        if (!hit) {
            break;
        }
    }
    assert_true(failures > 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_graphs_agree_with_the_graph_itself),
        cmocka_unit_test(single_operations_in_long_double_round_to_the_double_ones),
        cmocka_unit_test(random_graphs_in_long_double_agree_with_double),
        cmocka_unit_test(closed_forms_hold_to_eighteen_digits),
        cmocka_unit_test(fewer_outputs_give_the_same_values_in_fewer_slots),
        cmocka_unit_test(evaluation_allocates_nothing_and_repeats_to_the_bit),
        cmocka_unit_test(operations_are_counted_exactly),
        cmocka_unit_test(a_listing_shows_what_runs),
        cmocka_unit_test(a_chain_of_a_hundred_thousand_nodes_compiles_and_runs),
        cmocka_unit_test(equal_outputs_are_compiled_once_and_outlive_the_graph),
        cmocka_unit_test(both_forms_of_the_interpreter_give_the_same_bits),
        cmocka_unit_test(the_forms_are_compared_after_a_while_and_values_stay),
        cmocka_unit_test(out_of_memory_is_told_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
