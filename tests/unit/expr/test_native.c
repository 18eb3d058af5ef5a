// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/clock.h"
#include "base/file.h"
#include "expr/tape_code.h"
#include "expr/construct.h"
#include "expr/native.h"
#include "expr/parse.h"
#include "expr/tape.h"

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { N_IN = 3, STATES = 40, MOST_ANGLES = 20 };
static char folder[64], path[400];

static int set_up(void **state) {
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/holonom-native-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state) {
    (void)state;
    hn_native_stop();
    chmod(folder, 0700);
    DIR *d = opendir(folder);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        unlink(path);
    }
    closedir(d);
    return rmdir(folder);
}

/// Asks for every tape at its first run and compiles at its second.
static hn_native_opts eager(const char *compiler) {
    hn_native_opts opts = hn_native_opts_default(folder);
    opts.look_after = opts.build_after = 0;
    opts.compiler = compiler;
    return opts;
}

static void start(const char *compiler) {
    const hn_native_opts opts = eager(compiler);
    hn_native_start(&opts);
}

static hn_tape *compile(hn_graph *g, const hn_ex *out, int n_out) {
    int symbols[N_IN];
    hn_tape *tape = NULL;
    for (int i = 0; i < N_IN; i++) {
        symbols[i] = hn_graph_find_symbol(g, (const char *[]){"x", "y", "z"}[i]);
    }
    assert_int_equal(hn_tape_compile(g, out, n_out, symbols, N_IN, &tape), HN_OK);
    return tape;
}

static hn_graph *make_graph(void) {
    hn_graph *g = hn_graph_create();
    hn_symbol(g, "x", NULL);
    hn_symbol(g, "y", NULL);
    hn_symbol(g, "z", NULL);
    return g;
}

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
    hn_graph *g = make_graph();
    const hn_parse_opts opts = {.lookup = look_up, .user = g};
    hn_ex out[N];
    hn_diag diag = {0};
    for (int i = 0; i < N; i++) {
        if (hn_parse(g, formulas[i], &opts, &out[i], &diag) != HN_OK) {
            fail_msg("%s: %s", formulas[i], diag.message);
        }
    }
    hn_tape *tape = compile(g, out, N);
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

/// Thousands of instructions whose values cross from piece to piece.
static hn_tape *long_tape(int n) {
    hn_graph *g = make_graph();
    hn_ex x = hn_graph_symbol_expr(g, 0), y = hn_graph_symbol_expr(g, 1),
          z = hn_graph_symbol_expr(g, 2), early = hn_sin(g, hn_mul(g, x, y));
    for (int i = 0; i < n; i++) {
        const hn_ex s = hn_sin(g, hn_add(g, x, hn_scale(0.3, y)));
        y = hn_add(g, hn_mul(g, z, s), hn_scale(0.5, y));
        z = hn_sub(g, hn_mul(g, s, hn_num(0.25 + i)), hn_scale(0.9, z));
        x = hn_add(g, s, hn_scale(1e-3, early));
    }
    const hn_ex out[] = {x, y, z, early};
    hn_tape *tape = compile(g, out, 4);
    hn_graph_free(g);
    return tape;
}

static double input(int k, int i) {
    static const double corners[] = {0, -0.0, 1, 1e300, -1e-310, 3.5};
    return k < 6 ? corners[(k + 2 * i) % 6] : sin(12.9898 * k + 78.233 * i) * (k % 7);
}

/// Outputs at many states, corners among them.
static void eval_all(const hn_tape *tape, double *out) {
    const hn_tape_info info = hn_tape_get_info(tape);
    double *work = calloc(hn_tape_work_size(tape) + 1, sizeof *work);
    hn_tape_prepare(tape, work);
    for (int k = 0; k < STATES; k++) {
        const double in[N_IN] = {input(k, 0), input(k, 1), input(k, 2)};
        hn_tape_eval(tape, in, out + k * info.n_outputs, work);
    }
    free(work);
}

/// The tape is evaluated by the interpreter, then natively: not a bit may change.
static void assert_same_bits(hn_tape *(*make)(void)) {
    hn_tape *plain = make(); // made while the service is off
    const int n = hn_tape_get_info(plain).n_outputs * STATES;
    double *expected = malloc((size_t)n * sizeof *expected), *out = malloc((size_t)n * sizeof *out);
    eval_all(plain, expected);
    start(NULL);
    hn_tape *tape = make();
    eval_all(tape, out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 1);
    hn_poison_fill(out, (size_t)n);
    eval_all(tape, out);
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
    return long_tape(900);
}

static void a_tape_in_pieces_gives_the_bits_of_the_interpreter(void **state) {
    (void)state;
    hn_tape *tape = make_long();
    assert_true(hn_tape_get_info(tape).instructions > 2000);
    hn_tape_free(tape);
    assert_same_bits(make_long);
}

static hn_tape *small(void) {
    return long_tape(3);
}

/// Runs a tape until the queue has done what it can; the counts since the start.
static hn_native_counts run_small(void) {
    hn_tape *tape = small();
    double out[4 * STATES];
    eval_all(tape, out);
    hn_native_wait();
    const hn_native_counts counts = hn_native_get_counts();
    hn_tape_free(tape);
    return counts;
}

/// The compiled file in the folder, in `path`.
static void find_file(void) {
    DIR *d = opendir(folder);
    path[0] = 0;
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        if (strstr(e->d_name, ".so")) {
            snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        } else {
            assert_true(e->d_name[0] == '.'); // nothing else is left there
        }
    }
    closedir(d);
    assert_true(path[0]);
}

static void what_was_compiled_once_is_found_again(void **state) {
    (void)state;
    start(NULL);
    assert_int_equal(run_small().from_cache, 0);
    find_file();
    hn_native_stop();
    start(NULL);
    const hn_native_counts counts = run_small();
    assert_int_equal(counts.ready, 1);
    assert_int_equal(counts.from_cache, 1);
}

static void an_equal_tape_has_the_code_that_is_loaded_from_the_start(void **state) {
    (void)state;
    start(NULL);
    (void)run_small(); // compiled; the tape itself is gone
    const int before = hn_native_get_counts().ready;
    hn_tape *again = small(), *other = long_tape(20);
    assert_non_null(atomic_load(&again->native->code));
    assert_null(atomic_load(&other->native->code));
    assert_int_equal(hn_native_get_counts().ready, before); // nothing was loaded
    hn_tape_free(again);
    hn_tape_free(other);
}

static void a_file_that_is_cut_while_its_code_runs_harms_nothing(void **state) {
    (void)state;
    start(NULL);
    (void)run_small();
    find_file();
    assert_int_equal(truncate(path, 0), 0);
    hn_tape *again = small();
    double out[4 * STATES];
    assert_non_null(atomic_load(&again->native->code));
    eval_all(again, out);
    hn_tape_free(again);
}

static void flip_a_byte(void) {
    FILE *f = fopen(path, "r+b");
    assert_non_null(f);
    fseek(f, 2000, SEEK_SET);
    const int c = fgetc(f);
    fseek(f, 2000, SEEK_SET);
    fputc(c ^ 1, f);
    fclose(f);
}

static void cut_it(void) {
    assert_int_equal(truncate(path, 100), 0);
}

static void let_others_write(void) {
    assert_int_equal(chmod(path, 0666), 0);
}

static void make_it_a_pipe(void) {
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
}

static void make_it_a_link(void) {
    char real[500];
    snprintf(real, sizeof real, "%s.real", path);
    assert_int_equal(rename(path, real), 0);
    assert_int_equal(symlink(real, path), 0);
}

static void a_file_that_was_changed_is_compiled_anew(void **state) {
    (void)state;
    void (*const harm[])(void) = {flip_a_byte, cut_it, let_others_write, make_it_a_pipe,
                                  make_it_a_link};
    start(NULL);
    run_small();
    for (size_t i = 0; i < sizeof harm / sizeof *harm; i++) {
        find_file();
        harm[i]();
        hn_native_stop();
        start(NULL);
        const hn_native_counts counts = run_small();
        assert_int_equal(counts.ready, 1);
        assert_int_equal(counts.from_cache, 0);
        hn_native_stop();
        start(NULL);
        assert_int_equal(run_small().from_cache, 1); // and serves again
    }
}

/// A script in place of the compiler.
static const char *script(const char *text) {
    static char name[200];
    snprintf(name, sizeof name, "%s/.compiler", folder);
    FILE *f = fopen(name, "w");
    fputs(text, f);
    fclose(f);
    chmod(name, 0700);
    return name;
}

static void assert_interpreter_serves(const char *reason) {
    char text[HN_DIAG_MESSAGE];
    hn_tape *tape = small();
    double out[4 * STATES];
    hn_poison_fill(out, 4 * STATES);
    eval_all(tape, out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 0);
    eval_all(tape, out);
    assert_true(out[4 * 8] == out[4 * 8]); // state 8 has ordinary inputs
    hn_native_reason(text);
    if (!strstr(text, reason)) {
        fail_msg("'%s' is not in '%s'", reason, text);
    }
    hn_tape_free(tape);
}

static void a_compiler_that_fails_leaves_the_interpreter(void **state) {
    (void)state;
    start(script("#!/bin/sh\nexit 7\n"));
    assert_interpreter_serves("failed (exit status 7)");
}

static void a_compiler_that_hangs_is_killed(void **state) {
    (void)state;
    hn_native_opts opts = eager(script("#!/bin/sh\nsleep 100\n"));
    opts.time_limit = 0.2;
    const double before = hn_clock_wall();
    hn_native_start(&opts);
    assert_interpreter_serves("was killed after 0.2 s");
    assert_true(hn_clock_wall() - before < 20);
}

static void a_hanging_compiler_does_not_hold_up_the_end(void **state) {
    (void)state;
    start(script("#!/bin/sh\nsleep 100\n"));
    hn_tape *tape = small();
    double out[4 * STATES];
    eval_all(tape, out);
    usleep(50000);
    const double before = hn_clock_wall();
    hn_native_stop();
    assert_true(hn_clock_wall() - before < 20);
    hn_tape_free(tape);
}

static void a_compiler_that_writes_rubbish_leaves_the_interpreter(void **state) {
    (void)state;
    start(script("#!/bin/sh\nfor a; do case $b in -o) echo rubbish > $a;; esac; b=$a; done\n"));
    assert_interpreter_serves("could not be loaded");
}

static void code_that_differs_in_a_bit_is_dropped(void **state) {
    (void)state;
    // multiplies a constant of the C text: the last digit of 0.3
    start(script("#!/bin/sh\nfor s; do :; done\nsed -i 's/0x1.3333333333333p-2/"
                 "0x1.3333333333334p-2/g' $s\nexec gcc \"$@\"\n"));
    assert_interpreter_serves("differs from the interpreter");
}

static void no_compiler_and_a_folder_of_others_are_reported(void **state) {
    (void)state;
    const struct {
        const char *compiler, *folder, *reason;
        unsigned mode;
    } rows[] = {{"/nowhere/cc", folder, "there is no C compiler at /nowhere/cc", 0700},
                {NULL, folder, "only this user may write", 0777},
                {NULL, "/proc/nowhere", "cannot make the folder", 0700}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_native_opts opts = eager(rows[i].compiler);
        opts.folder = rows[i].folder;
        chmod(folder, rows[i].mode);
        hn_native_start(&opts);
        assert_interpreter_serves(rows[i].reason);
        hn_native_stop();
    }
}

static void a_suspended_thread_compiles_no_native_tapes(void **state) {
    (void)state;
    start(NULL);
    hn_native_suspend();
    hn_native_counts counts = run_small();
    assert_int_equal(counts.ready + counts.failed, 0);
    hn_native_resume();
    assert_int_equal(run_small().ready, 1);
}

static void a_full_disk_leaves_the_interpreter(void **state) {
    (void)state;
    struct rlimit before, small_limit;
    getrlimit(RLIMIT_FSIZE, &before);
    small_limit = before;
    small_limit.rlim_cur = 100;
    signal(SIGXFSZ, SIG_IGN);
    start(NULL);
    setrlimit(RLIMIT_FSIZE, &small_limit);
    hn_tape *tape = small();
    double out[4 * STATES];
    eval_all(tape, out);
    hn_native_wait();
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(hn_native_get_counts().failed, 1);
    char text[HN_DIAG_MESSAGE];
    hn_native_reason(text);
    assert_non_null(strstr(text, "File too large"));
    hn_tape_free(tape);
}

static void a_short_run_asks_for_nothing(void **state) {
    (void)state;
    const hn_native_opts opts = hn_native_opts_default(folder);
    hn_native_start(&opts);
    const hn_native_counts counts = run_small(); // 40 evaluations of some 30 instructions
    assert_int_equal(counts.ready + counts.failed, 0);
    DIR *d = opendir(folder);
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
    hn_tape *tape = long_tape(100);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_ERR_UNSUPPORTED);
    start(NULL);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_OK);
    assert_true(costs.compile_seconds > 0 && costs.emit_seconds > 0 && costs.load_seconds > 0);
    assert_true(costs.interpreter_ns > 0 && costs.native_ns > 0 && costs.break_even > 0);
    assert_int_equal(hn_native_measure(tape, &costs, &diag), HN_OK);
    assert_true(costs.compile_seconds == 0); // the folder has it now
    hn_tape_free(tape);
}

static void two_tapes_at_once_have_each_its_own_code(void **state) {
    (void)state;
    start(NULL);
    hn_tape *tape[2] = {long_tape(5), long_tape(6)};
    double out[4 * STATES];
    eval_all(tape[0], out);
    eval_all(tape[1], out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 2);
    hn_tape_free(tape[0]);
    hn_tape_free(tape[1]);
}

static void a_tape_may_be_freed_while_it_is_compiled(void **state) {
    (void)state;
    start(NULL);
    for (int i = 0; i < 3; i++) {
        hn_tape *tape = long_tape(20 + i);
        double out[4 * STATES];
        eval_all(tape, out);
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
        start(NULL);
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

#define ROW(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        ROW(every_operator_gives_the_bits_of_the_interpreter),
        ROW(angles_found_together_have_the_bits_of_single_ones),
        ROW(a_tape_in_pieces_gives_the_bits_of_the_interpreter),
        ROW(what_was_compiled_once_is_found_again),
        ROW(an_equal_tape_has_the_code_that_is_loaded_from_the_start),
        ROW(a_file_that_is_cut_while_its_code_runs_harms_nothing),
        ROW(a_file_that_was_changed_is_compiled_anew),
        ROW(a_compiler_that_fails_leaves_the_interpreter),
        ROW(a_compiler_that_hangs_is_killed),
        ROW(a_hanging_compiler_does_not_hold_up_the_end),
        ROW(a_compiler_that_writes_rubbish_leaves_the_interpreter),
        ROW(code_that_differs_in_a_bit_is_dropped),
        ROW(no_compiler_and_a_folder_of_others_are_reported),
        ROW(a_suspended_thread_compiles_no_native_tapes),
        ROW(a_full_disk_leaves_the_interpreter),
        ROW(a_short_run_asks_for_nothing),
        ROW(costs_are_measured),
        ROW(two_tapes_at_once_have_each_its_own_code),
        ROW(a_tape_may_be_freed_while_it_is_compiled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
