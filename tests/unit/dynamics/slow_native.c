// SPDX-License-Identifier: GPL-3.0-or-later
// Native tapes against the interpreter: every scene of the lessons, at random states, to the last
// bit, whatever moment the compiled code comes in.
#include "support/model.h"
#include "support/near.h"

#include "dynamics/evaluate/accel.h"
#include "expr/native.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { STATES = 25 };

/// Of -1 .. 1, the same on every machine.
static double noise(uint64_t *x) {
    *x = *x * 6364136223846793005ull + 1442695040888963407ull;
    return (double)(*x >> 11) * 0x1p-52 - 1;
}

typedef struct subject {
    hn_model m;
    hn_arena *arena;
    hn_accel *accel;
} subject;

static void open_accel(subject *s) {
    const hn_accel_opts opts = {.want_lambda = 1};
    s->arena = hn_arena_create(0);
    assert_int_equal(hn_accel_create(s->m.sys, &opts, s->arena, &s->accel), HN_OK);
}

static void close_accel(subject *s) {
    hn_accel_free(s->accel);
    hn_arena_free(s->arena);
}

/// Accelerations, multipliers and what was said of them at STATES states, one after the other.
static void eval_all(subject *s, double *out) {
    const size_t nq = (size_t)s->m.info.nq, nv = (size_t)s->m.info.nv, nc = (size_t)s->m.info.nc;
    double *q = calloc(nq + nv + 1, sizeof *q), *v = q + nq;
    uint64_t x = 42;
    for (int k = 0; k < STATES; k++, out += nv + nc + 2) {
        hn_accel_info info = {0};
        for (size_t i = 0; i < nq; i++) {
            q[i] = s->m.q[i] + 0.1 * k * noise(&x);
        }
        for (size_t i = 0; i < nv; i++) {
            v[i] = 3 * noise(&x);
        }
        hn_poison_fill(out, nv + nc + 2);
        out[nv + nc] = hn_accel_eval(s->accel, 0.1 * k, q, v, 0, 0, out, out + nv, &info);
        out[nv + nc + 1] = info.fallback;
    }
    free(q);
}

static void assert_bits(const char *scene, const double *a, const double *b, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]))) {
            fail_msg("%s: number %zu is %a natively, %a interpreted", scene, i, b[i], a[i]);
        }
    }
}

/// Three passes: interpreted; with the service on, where code comes in at some state; all native.
static void check_scene(const char *name, const char *folder) {
    subject s;
    hn_model_begin(&s.m, name, NULL);
    const size_t n = STATES * ((size_t)s.m.info.nv + (size_t)s.m.info.nc + 2);
    double *expected = malloc(n * sizeof *expected), *out = malloc(n * sizeof *out);
    open_accel(&s);
    const int has_tape = !hn_accel_tape_info(s.accel).n_inputs ? 0 : 1;
    eval_all(&s, expected);
    close_accel(&s);

    hn_native_opts opts = hn_native_opts_default(folder);
    opts.look_after = opts.build_after = 0;
    hn_native_start(&opts);
    open_accel(&s);
    eval_all(&s, out);
    assert_bits(name, expected, out, n);
    hn_native_wait();
    if (has_tape) {
        char why[HN_DIAG_MESSAGE];
        hn_native_reason(why);
        if (hn_native_get_counts().ready < 1 || hn_native_get_counts().failed > 0) {
            fail_msg("%s: not compiled: %s", name, why);
        }
    }
    eval_all(&s, out);
    assert_bits(name, expected, out, n);
    close_accel(&s);
    hn_native_stop();
    free(expected);
    free(out);
    hn_model_close(&s.m);
}

static void every_scene_gives_the_bits_of_the_interpreter(void **state) {
    (void)state;
    char folder[] = "/tmp/holonom-native-XXXXXX", name[256];
    glob_t files;
    assert_non_null(mkdtemp(folder));
    assert_int_equal(glob("lessons/*/scenes/*.json", 0, NULL, &files), 0);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        const char *base = strrchr(files.gl_pathv[i], '/') + 1;
        snprintf(name, sizeof name, "%.*s", (int)(strlen(base) - 5), base);
        check_scene(name, folder);
    }
    assert_true(files.gl_pathc > 20);
    globfree(&files);
    snprintf(name, sizeof name, "%s/*.so", folder);
    assert_int_equal(glob(name, 0, NULL, &files), 0);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        unlink(files.gl_pathv[i]);
    }
    globfree(&files);
    assert_int_equal(rmdir(folder), 0); // nothing else was left there
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_gives_the_bits_of_the_interpreter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
