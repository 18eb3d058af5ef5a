// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/native_tapes.h"

#include "expr/construct.h"
#include "support/near.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

char hn_native_folder[64];

int hn_native_tapes_set_up(void **state) {
    (void)state;
    snprintf(hn_native_folder, sizeof hn_native_folder, "/tmp/holonom-native-XXXXXX");
    return mkdtemp(hn_native_folder) ? 0 : -1;
}

int hn_native_tapes_tear_down(void **state) {
    (void)state;
    hn_native_stop();
    chmod(hn_native_folder, 0700);
    char path[400];
    DIR *d = opendir(hn_native_folder);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        snprintf(path, sizeof path, "%s/%s", hn_native_folder, e->d_name);
        unlink(path);
    }
    closedir(d);
    return rmdir(hn_native_folder);
}

hn_native_opts hn_native_eager(const char *compiler) {
    hn_native_opts opts = hn_native_opts_default(hn_native_folder);
    opts.look_after = opts.build_after = 0;
    opts.compiler = compiler;
    return opts;
}

void hn_native_start_eager(const char *compiler) {
    const hn_native_opts opts = hn_native_eager(compiler);
    hn_native_start(&opts);
}

hn_tape *hn_compile_xyz(hn_graph *g, const hn_ex *out, int n_out) {
    int symbols[HN_NATIVE_INPUTS];
    hn_tape *tape = NULL;
    for (int i = 0; i < HN_NATIVE_INPUTS; i++) {
        symbols[i] = hn_graph_find_symbol(g, (const char *[]){"x", "y", "z"}[i]);
    }
    assert_int_equal(hn_tape_compile(g, out, n_out, symbols, HN_NATIVE_INPUTS, &tape), HN_OK);
    return tape;
}

hn_graph *hn_graph_of_xyz(void) {
    hn_graph *g = hn_graph_create();
    hn_symbol(g, "x", NULL);
    hn_symbol(g, "y", NULL);
    hn_symbol(g, "z", NULL);
    return g;
}

hn_tape *hn_tape_long(int n) {
    hn_graph *g = hn_graph_of_xyz();
    hn_ex x = hn_graph_symbol_expr(g, 0), y = hn_graph_symbol_expr(g, 1),
          z = hn_graph_symbol_expr(g, 2), early = hn_sin(g, hn_mul(g, x, y));
    for (int i = 0; i < n; i++) {
        const hn_ex s = hn_sin(g, hn_add(g, x, hn_scale(0.3, y)));
        y = hn_add(g, hn_mul(g, z, s), hn_scale(0.5, y));
        z = hn_sub(g, hn_mul(g, s, hn_num(0.25 + i)), hn_scale(0.9, z));
        x = hn_add(g, s, hn_scale(1e-3, early));
    }
    const hn_ex out[] = {x, y, z, early};
    hn_tape *tape = hn_compile_xyz(g, out, 4);
    hn_graph_free(g);
    return tape;
}

static double input(int k, int i) {
    static const double corners[] = {0, -0.0, 1, 1e300, -1e-310, 3.5};
    return k < 6 ? corners[(k + 2 * i) % 6] : sin(12.9898 * k + 78.233 * i) * (k % 7);
}

void hn_tape_eval_states(const hn_tape *tape, double *out) {
    const hn_tape_info info = hn_tape_get_info(tape);
    double *work = calloc(hn_tape_work_size(tape) + 1, sizeof *work);
    hn_tape_prepare(tape, work);
    for (int k = 0; k < HN_NATIVE_STATES; k++) {
        const double in[HN_NATIVE_INPUTS] = {input(k, 0), input(k, 1), input(k, 2)};
        hn_tape_eval(tape, in, out + k * info.n_outputs, work);
    }
    free(work);
}

hn_tape *hn_tape_small(void) {
    return hn_tape_long(3);
}

hn_native_counts hn_native_run_small(void) {
    hn_tape *tape = hn_tape_small();
    double out[4 * HN_NATIVE_STATES];
    hn_tape_eval_states(tape, out);
    hn_native_wait();
    const hn_native_counts counts = hn_native_get_counts();
    hn_tape_free(tape);
    return counts;
}
