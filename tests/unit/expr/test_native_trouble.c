// SPDX-License-Identifier: GPL-3.0-or-later
// Kept files of compiled tapes, and runs while files or the compiler fail.
#include "support/native_tapes.h"
#include "support/near.h"

#include "base/clock.h"
#include "expr/tape_code.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char path[400];

/// The compiled file in the folder, in `path`.
static void find_file(void) {
    DIR *d = opendir(hn_native_folder);
    path[0] = 0;
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        if (strstr(e->d_name, ".so")) {
            snprintf(path, sizeof path, "%s/%s", hn_native_folder, e->d_name);
        } else {
            assert_true(e->d_name[0] == '.'); // nothing else is left there
        }
    }
    closedir(d);
    assert_true(path[0]);
}

static void what_was_compiled_once_is_found_again(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    assert_int_equal(hn_native_run_small().from_cache, 0);
    find_file();
    hn_native_stop();
    hn_native_start_eager(NULL);
    const hn_native_counts counts = hn_native_run_small();
    assert_int_equal(counts.ready, 1);
    assert_int_equal(counts.from_cache, 1);
}

static void a_file_that_is_cut_while_its_code_runs_harms_nothing(void **state) {
    (void)state;
    hn_native_start_eager(NULL);
    (void)hn_native_run_small();
    find_file();
    assert_int_equal(truncate(path, 0), 0);
    hn_tape *again = hn_tape_small();
    double out[4 * HN_NATIVE_STATES];
    assert_non_null(atomic_load(&again->native->code));
    hn_tape_eval_states(again, out);
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
    hn_native_start_eager(NULL);
    hn_native_run_small();
    for (size_t i = 0; i < sizeof harm / sizeof *harm; i++) {
        find_file();
        harm[i]();
        hn_native_stop();
        hn_native_start_eager(NULL);
        const hn_native_counts counts = hn_native_run_small();
        assert_int_equal(counts.ready, 1);
        assert_int_equal(counts.from_cache, 0);
        hn_native_stop();
        hn_native_start_eager(NULL);
        assert_int_equal(hn_native_run_small().from_cache, 1); // and serves again
    }
}

/// A script in place of the compiler.
static const char *script(const char *text) {
    static char name[200];
    snprintf(name, sizeof name, "%s/.compiler", hn_native_folder);
    FILE *f = fopen(name, "w");
    fputs(text, f);
    fclose(f);
    chmod(name, 0700);
    return name;
}

static void assert_interpreter_serves(const char *reason) {
    char text[HN_DIAG_MESSAGE];
    hn_tape *tape = hn_tape_small();
    double out[4 * HN_NATIVE_STATES];
    hn_poison_fill(out, 4 * HN_NATIVE_STATES);
    hn_tape_eval_states(tape, out);
    hn_native_wait();
    assert_int_equal(hn_native_get_counts().ready, 0);
    hn_tape_eval_states(tape, out);
    assert_true(out[4 * 8] == out[4 * 8]); // state 8 has ordinary inputs
    hn_native_reason(text);
    if (!strstr(text, reason)) {
        fail_msg("'%s' is not in '%s'", reason, text);
    }
    hn_tape_free(tape);
}

static void a_compiler_that_fails_leaves_the_interpreter(void **state) {
    (void)state;
    hn_native_start_eager(script("#!/bin/sh\nexit 7\n"));
    assert_interpreter_serves("failed (exit status 7)");
}

static void a_compiler_that_hangs_is_killed(void **state) {
    (void)state;
    hn_native_opts opts = hn_native_eager(script("#!/bin/sh\nsleep 100\n"));
    opts.time_limit = 0.2;
    const double before = hn_clock_wall();
    hn_native_start(&opts);
    assert_interpreter_serves("was killed after 0.2 s");
    assert_true(hn_clock_wall() - before < 20);
}

static void a_hanging_compiler_does_not_hold_up_the_end(void **state) {
    (void)state;
    hn_native_start_eager(script("#!/bin/sh\nsleep 100\n"));
    hn_tape *tape = hn_tape_small();
    double out[4 * HN_NATIVE_STATES];
    hn_tape_eval_states(tape, out);
    usleep(50000);
    const double before = hn_clock_wall();
    hn_native_stop();
    assert_true(hn_clock_wall() - before < 20);
    hn_tape_free(tape);
}

static void a_compiler_that_writes_rubbish_leaves_the_interpreter(void **state) {
    (void)state;
    hn_native_start_eager(
        script("#!/bin/sh\nfor a; do case $b in -o) echo rubbish > $a;; esac; b=$a; done\n"));
    assert_interpreter_serves("could not be loaded");
}

static void code_that_differs_in_a_bit_is_dropped(void **state) {
    (void)state;
    // multiplies a constant of the C text: the last digit of 0.3
    hn_native_start_eager(script("#!/bin/sh\nfor s; do :; done\nsed -i 's/0x1.3333333333333p-2/"
                                 "0x1.3333333333334p-2/g' $s\nexec gcc \"$@\"\n"));
    assert_interpreter_serves("differs from the interpreter");
}

static void no_compiler_and_a_folder_of_others_are_reported(void **state) {
    (void)state;
    const struct {
        const char *compiler, *folder, *reason;
        unsigned mode;
    } rows[] = {{"/nowhere/cc", hn_native_folder, "there is no C compiler at /nowhere/cc", 0700},
                {NULL, hn_native_folder, "only this user may write", 0777},
                {NULL, "/proc/nowhere", "cannot make the folder", 0700}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_native_opts opts = hn_native_eager(rows[i].compiler);
        opts.folder = rows[i].folder;
        chmod(hn_native_folder, rows[i].mode);
        hn_native_start(&opts);
        assert_interpreter_serves(rows[i].reason);
        hn_native_stop();
    }
}

static void a_full_disk_leaves_the_interpreter(void **state) {
    (void)state;
    struct rlimit before, small_limit;
    getrlimit(RLIMIT_FSIZE, &before);
    small_limit = before;
    small_limit.rlim_cur = 100;
    signal(SIGXFSZ, SIG_IGN);
    hn_native_start_eager(NULL);
    setrlimit(RLIMIT_FSIZE, &small_limit);
    hn_tape *tape = hn_tape_small();
    double out[4 * HN_NATIVE_STATES];
    hn_tape_eval_states(tape, out);
    hn_native_wait();
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(hn_native_get_counts().failed, 1);
    char text[HN_DIAG_MESSAGE];
    hn_native_reason(text);
    assert_non_null(strstr(text, "File too large"));
    hn_tape_free(tape);
}

#define ROW(name) \
    cmocka_unit_test_setup_teardown(name, hn_native_tapes_set_up, hn_native_tapes_tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        ROW(what_was_compiled_once_is_found_again),
        ROW(a_file_that_is_cut_while_its_code_runs_harms_nothing),
        ROW(a_file_that_was_changed_is_compiled_anew),
        ROW(a_compiler_that_fails_leaves_the_interpreter),
        ROW(a_compiler_that_hangs_is_killed),
        ROW(a_hanging_compiler_does_not_hold_up_the_end),
        ROW(a_compiler_that_writes_rubbish_leaves_the_interpreter),
        ROW(code_that_differs_in_a_bit_is_dropped),
        ROW(no_compiler_and_a_folder_of_others_are_reported),
        ROW(a_full_disk_leaves_the_interpreter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
