// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of each loop of the ladder as loops are added, N = 10 to 1,000: reading and compiling the
// scene, assembling it, beginning a run, a step of it, and memory. Every size is a process of its
// own, interpreted. Prints CSV; `per_loop_to_first` is the figure for each loop against that of the
// first size.
#include "base/clock.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/compile.h"
#include "study/run/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { COMPILE, ASSEMBLE, BEGIN, STEP, MEMORY, N_FIGURES };
static const char *const NAMES[N_FIGURES] = {"compile_seconds", "assemble_seconds", "begin_seconds",
                                             "step_seconds", "megabytes"};
static const int SIZES[] = {10, 30, 100, 300, 1000};
enum { N_SIZES = sizeof SIZES / sizeof *SIZES, STEPS = 20 };
static const double H = 1e-3; // [s]

static void give_up(const char *what) {
    fprintf(stderr, "%s failed\n", what);
    exit(3);
}

static double megabytes(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

static double since(double *start) {
    const double now = hn_clock_thread(), passed = now - *start;
    *start = now;
    return passed;
}

/// One size, in a process that has done nothing else.
static void measure(int n, double out[N_FIGURES]) {
    hn_diags diags = {0};
    hn_diag diag = {0};
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    hn_run *run = NULL;
    const double before = megabytes();
    double start = hn_clock_thread();
    const hn_setting setting = {.name = "N", .value = n};
    if (hn_scene_load_file("lessons/01-closed-loops/scenes/n-four-bar.json", &setting, 1, &scene,
                           &diags) != HN_OK ||
        hn_system_compile(scene, NULL, &sys, &diags) != HN_OK) {
        give_up("compiling");
    }
    out[COMPILE] = since(&start);

    // consistent values
    const hn_system_info info = hn_system_get_info(sys);
    hn_arena *arena = hn_arena_create(0);
    double *q = hn_arena_doubles(arena, (size_t)info.nq);
    double *v = hn_arena_doubles(arena, (size_t)info.nv);
    if (hn_assemble(sys, 0, q, v, NULL, NULL, NULL, &diags) != HN_OK) {
        give_up("assembling");
    }
    out[ASSEMBLE] = since(&start);

    // a run, its first step apart
    hn_method_spec method;
    if (hn_method_parse("index1@rk4:h=1e-3", &method, &diag) != HN_OK ||
        hn_run_create(sys, &method, q, v, NULL, &run, &diag) != HN_OK ||
        hn_run_advance(run, H) != HN_OK) {
        give_up("beginning");
    }
    out[BEGIN] = since(&start);
    if (hn_run_advance(run, (1 + STEPS) * H) != HN_OK) {
        give_up("running");
    }
    out[STEP] = since(&start) / STEPS;
    out[MEMORY] = megabytes() - before;
}

static void measure_apart(int n, double out[N_FIGURES]) {
    int ends[2], status = 0;
    if (pipe(ends) != 0) {
        give_up("pipe");
    }
    const pid_t child = fork();
    if (child == 0) {
        double figures[N_FIGURES];
        measure(n, figures);
        _exit(write(ends[1], figures, sizeof figures) == sizeof figures ? 0 : 3);
    }
    close(ends[1]);
    const ssize_t got = read(ends[0], out, N_FIGURES * sizeof *out);
    close(ends[0]);
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0 ||
        got != (ssize_t)(N_FIGURES * sizeof *out)) {
        give_up("a size");
    }
}

int main(void) {
    double first[N_FIGURES] = {0};
    printf("loops,figure,value,per_loop,per_loop_to_first\n");
    for (int k = 0; k < N_SIZES; k++) {
        double figures[N_FIGURES];
        measure_apart(SIZES[k], figures);
        for (int i = 0; i < N_FIGURES; i++) {
            const double each = figures[i] / SIZES[k];
            first[i] = k == 0 ? each : first[i];
            printf("%d,%s,%.4g,%.4g,%.3g\n", SIZES[k], NAMES[i], figures[i], each, each / first[i]);
        }
    }
    return 0;
}
