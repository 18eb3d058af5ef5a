// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled tapes: their bits are those of the interpreter, and they are made when they pay.
#include "support/native_tapes.h"
#include "support/near.h"

#include "expr/construct.h"
#include "expr/parse.h"
#include "expr/tape_code.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ANGLES = 20 };

static int look_up(void *user, const char *name, hn_ex *out) {
    const int symbol = hn_graph_find_symbol(user, name);
    *out = symbol >= 0 ? hn_graph_symbol_expr(user, symbol) : hn_num(0);
    return symbol >= 0;
}

/// Every operator and every shape of sum and product.
static hn_tape *tape_of_everything(void) {
    static const char *const formulas[] = {"sin(x)",
                                           "cos(x)",
                                           "sin(y)",
                                           "cos(z)",
                                           "tan(x) + asin(y/9)",
                                           "acos(z/9)",
                                           "atan(x)",
                                           "atan2(x, y)",
                                           "sinh(x)",
                                           "cosh(y)",
                                           "tanh(z)",
                                           "exp(x)",
                                           "log(abs(y) + 1)",
                                           "pow(abs(x), 1.7)",
                                           "abs(x)",
                                           "sign(y)",
                                           "step(z)",
                                           "min(x, y)",
                                           "max(y, z)",
                                           "sqrt(x)",
                                           "1/x",
                                           "x*y*z",
                                           "x*y*z*sin(x)",
                                           "(x + y)*z",
                                           "(x - y)*z",
                                           "x*y + z",
                                           "x*y - z",
                                           "x - y*z",
                                           "x*y + y*z",
                                           "x*y - y*z + x*z",
                                           "x + y + z",
                                           "x - y - z",
                                           "3*x - 0.1*y*z - exp(z)",
                                           "-x",
                                           "x",
                                           "2.5"};
    enum { N = sizeof formulas / sizeof *formulas };
    hn_graph *g = hn_graph_of_xyz();
    const hn_parse_opts opts = {.lookup = look_up, .user = g};
    hn_ex out[N];
    hn_diag diag = {0};
    for (int i = 0; i < N; i++) {
        if (hn_parse(g, formulas[i], &opts, &out[i], &diag) != HN_OK) {
            fail_msg("%s: %s", formulas[i], diag.message);
        }
    }
    hn_tape *tape = hn_compile_xyz(g, out, N);
    hn_graph_free(g);
    return tape;
}

/// Sine and cosine of n inputs, one of a sum, one without its cosine; 2 n + 3 outputs.
static hn_tape *tape_of_angles(int n) {
    int symbols[MOST_ANGLES];
    hn_ex out[2 * MOST_ANGLES + 3];
    hn_graph *g = hn_graph_create();
    for (int i = 0; i < n; i++) {
        char name[8];
        snprintf(name, sizeof name, "x%d", i);
        const hn_ex x = hn_symbol(g, name, NULL);
        symbols[i] = hn_ex_symbol(g, x);
        out[2 * i] = hn_sin(g, x);
        out[2 * i + 1] = i == 1 ? x : hn_cos(g, x); // of the second the sine alone
    }
    const hn_ex sum = hn_add(g, hn_graph_symbol_expr(g, 0), hn_graph_symbol_expr(g, 2));
    out[2 * n] = hn_sin(g, sum);
    out[2 * n + 1] = hn_cos(g, sum);
    out[2 * n + 2] = hn_mul(g, out[0], out[5]);
    hn_tape *tape = NULL;
    assert_int_equal(hn_tape_compile(g, out, 2 * n + 3, symbols, n, &tape), HN_OK);
    hn_graph_free(g);
    return tape;
}

/// The tape is evaluated by the interpreter, then natively: not a bit may change.
static void assert_same_bits(hn_tape *(*make)(void)) {
    hn_tape *plain = make(); // made while the service is off
    const int n = hn_tape_get_info(plain).n_outputs * HN_NATIVE_STATES;
    double *expected = malloc((size_t)n * sizeof *expected), *out = malloc((size_t)n * sizeof *out);
    hn_tape_eval_states(plain, expected);
    hn_native_start_eager(NULL);
    hn_tape *tape = make();
    hn_tape_eval_states(tape, out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 1);
    hn_poison_fill(out, (size_t)n);
    hn_tape_eval_states(tape, out);
    for (int i = 0; i < n; i++) {
        if (memcmp(&out[i], &expected[i], sizeof *out) != 0 &&
            !(isnan(out[i]) && isnan(expected[i]))) {
            fail_msg("output %d: %a, not %a", i, out[i], expected[i]);
        }
    }
    hn_tape_free(plain);
    hn_tape_free(tape);
    free(expected);
    free(out);
}

static void every_operator_gives_the_bits_of_the_interpreter(void **state) {
    (void)state;
    assert_same_bits(tape_of_everything);
}

static hn_tape *make_long(void) {
    return hn_tape_long(900);
}

static void a_tape_in_pieces_gives_the_bits_of_the_interpreter(void **state) {
    (void)state;
    hn_tape *tape = make_long();
    assert_true(hn_tape_get_info(tape).instructions > 2000);
    hn_tape_free(tape);
    assert_same_bits(make_long);
}

static void an_equal_tape_has_the_code_that_is_loaded_from_the_start(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    (void)hn_native_run_small(); // compiled; the tape itself is gone
    const int before = hn_native_get_counts().ready;
    hn_tape *again = hn_tape_small(), *other = hn_tape_long(20);
    assert_non_null(atomic_load(&again->native->code));
    assert_null(atomic_load(&other->native->code));
    assert_int_equal(hn_native_get_counts().ready, before); // nothing was loaded
    hn_tape_free(again);
    hn_tape_free(other);
}

static void a_suspended_thread_compiles_no_native_tapes(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    hn_native_suspend();
    hn_native_counts counts = hn_native_run_small();
    assert_int_equal(counts.ready + counts.failed, 0);
    hn_native_resume();
    assert_int_equal(hn_native_run_small().ready, 1);
}

static void a_short_run_asks_for_nothing(void **state) {
    (void)state;
    const hn_native_opts opts = hn_native_opts_default(hn_native_folder);
    hn_native_start(&opts);
    const hn_native_counts counts = hn_native_run_small(); // 40 evaluations of some 30 instructions
    assert_int_equal(counts.ready + counts.failed, 0);
    DIR *d = opendir(hn_native_folder);
    int n = 0;
    while (readdir(d)) {
        n++;
    }
    closedir(d);
    assert_int_equal(n, 2); // . and ..
}

static void costs_are_measured(void **state) {
    (void)state;
    hn_native_costs costs;
    hn_diag diag = {0};
    hn_tape *tape = hn_tape_long(100);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_ERR_UNSUPPORTED);
    hn_native_start_eager(NULL);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_OK);
    assert_true(costs.compile_seconds > 0 && costs.emit_seconds > 0 && costs.load_seconds > 0);
    assert_true(costs.interpreter_ns > 0 && costs.native_ns > 0 && costs.break_even > 0);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_OK);
    assert_true(costs.compile_seconds == 0); // the folder has it now
    hn_tape_free(tape);
}

static void a_tape_too_long_for_the_caches_stays_with_the_interpreter(void **state) {
    (void)state;
    hn_native_costs costs;
    hn_diag diag = {0};
    hn_native_start_eager(NULL);
    hn_tape *tape = hn_tape_long(14000);
    const int n = hn_tape_get_info(tape).n_outputs * HN_NATIVE_STATES;
    double *out = malloc((size_t)n * sizeof *out);
    assert_true(hn_tape_get_info(tape).instructions > 40000);
    hn_tape_eval_states(tape, out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 0);
    assert_int_equal(hn_native_get_counts().failed, 0);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_ERR_LIMIT);
    assert_non_null(strstr(diag.message, "slower than the interpreter"));
    assert_true(costs.instructions > 40000);
    free(out);
    hn_tape_free(tape);
}

static void two_tapes_at_once_have_each_its_own_code(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    hn_tape *tape[2] = {hn_tape_long(5), hn_tape_long(6)};
    double out[4 * HN_NATIVE_STATES];
    hn_tape_eval_states(tape[0], out);
    hn_tape_eval_states(tape[1], out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 2);
    hn_tape_free(tape[0]);
    hn_tape_free(tape[1]);
}

static void a_tape_may_be_freed_while_it_is_compiled(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    for (int i = 0; i < 3; i++) {
        hn_tape *tape = hn_tape_long(20 + i);
        double out[4 * HN_NATIVE_STATES];
        hn_tape_eval_states(tape, out);
        hn_tape_free(tape);
    }
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().failed, 0);
}

static void eval_angles(const hn_tape *tape, const double *in, double *out) {
    double work[200];
    assert_true(hn_tape_work_size(tape) <= 200);
    hn_tape_prepare(tape, work);
    hn_tape_eval(tape, in, out, work);
}

static void assert_equal_bits(const double *out, const double *wanted, int n) {
    for (int i = 0; i < n; i++) {
        const bool both_nan = isnan(out[i]) && isnan(wanted[i]);
        assert_true(both_nan || memcmp(&out[i], &wanted[i], sizeof *out) == 0);
    }
}

/// Interpreted and compiled code find the angles of inputs together: in one vector, in one that is
/// not full, in more. Each has the bits of the C library's function, called for it alone.
static void angles_found_together_have_the_bits_of_single_ones(void **state) {
    (void)state;
    static const int counts[] = {3, 4, 5, 6, 8, 9, 10, 16, 17, MOST_ANGLES}; // one is a lone sine
    static const double ends[] = {0, -0.0, 1e-300, 0.126, 0.855469, 2.426265, 1e8, 1e9, 1e300};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        const int n = counts[k];
        hn_tape *single = tape_of_angles(n), *plain = tape_of_angles(n); // the service is off yet
        assert_int_equal(single->n_angles, n - 1);
        assert_ptr_equal(plain->four, hn_lanes_sincos_four_get());
        single->four = NULL;
        hn_native_start_eager(NULL);
        hn_tape *tape = tape_of_angles(n);
        double in[MOST_ANGLES] = {0}, out[2 * MOST_ANGLES + 3], wanted[2 * MOST_ANGLES + 3];
        eval_angles(tape, in, out);
        eval_angles(tape, in, out);
        hn_native_wait();
        assert_int_equal(hn_native_get_counts().ready, 1);

        unsigned seed = 3;
        for (int at = 0; at < 400; at++) {
            for (int i = 0; i < n; i++) {
                seed = seed * 1664525u + 1013904223u;
                const double u = (double)seed * 0x1p-31 - 1; // -1 .. 1
                in[i] = seed % 5 ? 12 * u : ends[seed / 5 % 9] * (seed & 64 ? 1 + 1e-7 * u : 1);
            }
            in[0] = at == 7 ? (double)INFINITY : in[0];
            eval_angles(single, in, wanted);
            eval_angles(plain, in, out);
            assert_equal_bits(out, wanted, 2 * n + 3);
            eval_angles(tape, in, out);
            assert_equal_bits(out, wanted, 2 * n + 3);
        }
        hn_tape_free(tape);
        hn_tape_free(plain);
        hn_tape_free(single);
        hn_native_stop();
    }
}

// x and y are the answer, then a pivot x beside its reference z, then rows y and z
static hn_tape *tape_with_check(void) {
    const hn_tape_check check = {.n_answer = 2, .n_pairs = 1, .n_rows = 2, .pair = 0.5, .row = 0.1};
    const int symbols[] = {0, 1, 2};
    hn_tape *tape = NULL;
    hn_graph *g = hn_graph_of_xyz();
    hn_ex of[3], out[6];
    for (int i = 0; i < 3; i++) { // products, so that the code has something to find
        const hn_ex x = hn_graph_symbol_expr(g, i);
        of[i] = hn_mul(g, x, hn_mul(g, x, x));
    }
    const int order[6] = {0, 1, 0, 2, 1, 2};
    for (int i = 0; i < 6; i++) {
        out[i] = of[order[i]];
    }
    assert_int_equal(hn_tape_compile_checked(g, out, 6, symbols, 3, &check, &tape), HN_OK);
    hn_graph_free(g);
    return tape;
}

static bool is_sure(const hn_tape *tape, double x, double y, double z) {
    double work[32] = {0};
    assert_true(hn_tape_work_size(tape) <= 32);
    hn_tape_prepare(tape, work);
    work[0] = x, work[1] = y, work[2] = z;
    const hn_tape_verdict verdict = hn_tape_run_checked(tape, work);
    const bool holds = hn_tape_check_holds(&tape->check, hn_tape_output_slots(tape), work);
    if (verdict == HN_TAPE_UNCHECKED) {
        return holds;
    }
    assert_int_equal(verdict == HN_TAPE_SURE, holds); // the code says what the library says
    return verdict == HN_TAPE_SURE;
}

static void assert_checks(const hn_tape *tape) {
    assert_true(is_sure(tape, 1, 1, 1));
    assert_true(is_sure(tape, -1, 1, -1));  // sizes, not signs
    assert_true(is_sure(tape, 2, 1, 1));    // a pivot may be large
    assert_false(is_sure(tape, 0.7, 1, 1)); // 0.343 of its reference
    assert_false(is_sure(tape, 1, 0.4, 1)); // a row of 0.064 beside 1
    assert_false(is_sure(tape, 1, 1, 0.4));
    assert_false(is_sure(tape, 0, 0, 0)); // nothing is above nothing
    const double not_numbers[] = {nan(""), HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 3; i++) {
        const double x = not_numbers[i];
        assert_false(is_sure(tape, x, 1, 1));
        assert_false(is_sure(tape, 1, x, 1));
        assert_false(is_sure(tape, 1, 1, x));
        assert_false(is_sure(tape, x, x, x));
    }
}

/// Made and compiled: looked up at its first run, built at its second.
static hn_tape *native_tape_with_check(void) {
    hn_native_start_eager(NULL);
    hn_tape *tape = tape_with_check();
    is_sure(tape, 1, 1, 1);
    is_sure(tape, 1, 1, 1);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 1);
    return tape;
}

static void native_code_says_whether_the_answer_is_sure(void **state) {
    (void)state;
    hn_tape *plain = tape_with_check();
    assert_checks(plain);
    hn_tape *tape = native_tape_with_check();
    double work[32] = {0};
    hn_tape_prepare(tape, work);
    assert_int_not_equal(hn_tape_run_checked(tape, work), HN_TAPE_UNCHECKED); // it looks by itself
    assert_checks(tape);
    hn_tape_free(tape);
    hn_tape_free(plain);
}

// The same operations with another check are other code.
static void tapes_with_other_checks_have_each_its_own_code(void **state) {
    (void)state;
    hn_tape *tape = native_tape_with_check();
    hn_tape *other = tape_with_check();
    assert_non_null(other->native->loaded);
    other->check.pair = 0.9;
    hn_native_state_release(other->native);
    other->native = hn_native_state_create(other, HN_NATIVE_SINGLE);
    assert_null(other->native->loaded);
    assert_true(is_sure(tape, 0.9, 1, 1)); // 0.729
    assert_false(is_sure(other, 0.9, 1, 1));
    hn_tape_free(other);
    hn_tape_free(tape);
}

#define ROW(name) \
    cmocka_unit_test_setup_teardown(name, hn_native_tapes_set_up, hn_native_tapes_tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        ROW(every_operator_gives_the_bits_of_the_interpreter),
        ROW(angles_found_together_have_the_bits_of_single_ones),
        ROW(a_tape_in_pieces_gives_the_bits_of_the_interpreter),
        ROW(an_equal_tape_has_the_code_that_is_loaded_from_the_start),
        ROW(native_code_says_whether_the_answer_is_sure),
        ROW(tapes_with_other_checks_have_each_its_own_code),
        ROW(a_suspended_thread_compiles_no_native_tapes),
        ROW(a_short_run_asks_for_nothing),
        ROW(costs_are_measured),
        ROW(a_tape_too_long_for_the_caches_stays_with_the_interpreter),
        ROW(two_tapes_at_once_have_each_its_own_code),
        ROW(a_tape_may_be_freed_while_it_is_compiled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
