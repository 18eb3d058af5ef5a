// SPDX-License-Identifier: GPL-3.0-or-later
// One evaluation of accelerations and multipliers: the reference four-bar FB0 through its tape
// beside the same equations written by hand for this one mechanism, and the ladder of N four-bars
// for its growth with N. Prints CSV.
//
// Every result feeds the next input, so that no evaluation can be hoisted or overlapped more than
// in a real step. Batches of the two alternate; the smallest is what the machine can do, the median
// what it did.
#include "hand_fourbar.h"

#include "dynamics/compile/compile.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BATCHES = 31, EVALS = 20000 };

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct subject {
    hn_scene *scene;
    hn_system *sys;
    hn_arena *arena;
    hn_accel *accel;
    double compile_seconds;
    double *q, *v, *a, *lambda;
    int n;
} subject;

static int open_subject(const char *path, const hn_setting *setting, subject *s) {
    hn_diags diags = {0};
    if (hn_scene_load_file(path, setting, setting ? 1 : 0, &s->scene, &diags) != HN_OK) {
        fprintf(stderr, "%s: %s\n", path, diags.item[0].message);
        return 0;
    }
    s->arena = hn_arena_create(0);
    const hn_accel_opts opts = {.want_lambda = 1};
    double start = seconds();
    if (hn_system_compile(s->scene, NULL, &s->sys, &diags) != HN_OK ||
        hn_accel_create(s->sys, &opts, s->arena, &s->accel) != HN_OK) {
        fprintf(stderr, "%s: %s\n", path, diags.item[0].message);
        return 0;
    }
    s->compile_seconds = seconds() - start;
    hn_system_info info = hn_system_get_info(s->sys);
    s->n = info.nv;
    s->q = hn_arena_doubles(s->arena, (size_t)info.nv);
    s->v = hn_arena_doubles(s->arena, (size_t)info.nv);
    s->a = hn_arena_doubles(s->arena, (size_t)info.nv);
    s->lambda = hn_arena_doubles(s->arena, (size_t)info.nc + 1);
    return 1;
}

static void close_subject(subject *s) {
    hn_accel_free(s->accel);
    hn_system_free(s->sys);
    hn_arena_free(s->arena);
    hn_scene_free(s->scene);
}

/// CPU seconds of `evals` evaluations through the tape.
static double time_tape(subject *s, int evals) {
    double start = seconds();
    for (int k = 0; k < evals; k++) {
        hn_accel_info info;
        if (hn_accel_eval(s->accel, 0, s->q, s->v, 0, 0, s->a, s->lambda, &info) != HN_OK ||
            info.fallback) {
            fprintf(stderr, "the tape did not answer\n");
            exit(3);
        }
        for (int i = 0; i < s->n; i++) { // angles that stay would be found once only
            s->q[i] += 1e-12 * s->v[i];
            s->v[i] += 1e-12 * s->a[i];
        }
    }
    return seconds() - start;
}

static double time_hand(double *q, double *v, double *a, double *lambda, int evals) {
    double start = seconds();
    for (int k = 0; k < evals; k++) {
        hn_hand_fourbar(q, v, a, lambda);
        for (int i = 0; i < 3; i++) {
            q[i] += 1e-12 * v[i];
            v[i] += 1e-12 * a[i];
        }
    }
    return seconds() - start;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int bench_fb0(void) {
    subject s;
    if (!open_subject("lessons/01-closed-loops/scenes/fb0.json", NULL, &s)) {
        return 1;
    }
    const double start[6] = {1, 0.498324904142577, 1.516841745037813, 2, -0.3, 0.9};
    double q[3], v[3], a[3], lambda[2], tape[BATCHES], hand[BATCHES], worst = 0;
    for (int i = 0; i < 3; i++) {
        s.q[i] = q[i] = start[i];
        s.v[i] = v[i] = start[3 + i];
    }
    for (int k = 0; k < BATCHES; k++) {
        tape[k] = time_tape(&s, EVALS) / EVALS * 1e9;
        hand[k] = time_hand(q, v, a, lambda, EVALS) / EVALS * 1e9;
    }
    for (int i = 0; i < 3; i++) { // the same numbers, or the comparison means nothing
        worst = fmax(worst, fabs(a[i] - s.a[i]));
    }
    worst = fmax(worst, fmax(fabs(lambda[0] - s.lambda[0]), fabs(lambda[1] - s.lambda[1])));
    qsort(tape, BATCHES, sizeof *tape, ascending);
    qsort(hand, BATCHES, sizeof *hand, ascending);
    const int mid = BATCHES / 2;
    hn_tape_info info = hn_accel_tape_info(s.accel);
    printf("case,ops,instructions,tape_ns_min,tape_ns_median,hand_ns_min,hand_ns_median,ratio_min,"
           "ratio_median,difference\n");
    printf("fb0,%d,%d,%.1f,%.1f,%.1f,%.1f,%.2f,%.2f,%.1e\n", info.ops, info.instructions, tape[0],
           tape[mid], hand[0], hand[mid], tape[0] / hand[0], tape[mid] / hand[mid], worst);
    close_subject(&s);
    return 0;
}

static int bench_ladder(int loops) {
    subject s;
    const hn_setting setting = {"N", loops};
    if (!open_subject("lessons/01-closed-loops/scenes/n-four-bar.json", &setting, &s)) {
        return 1;
    }
    double batch[BATCHES];
    for (int i = 0; i < s.n; i++) { // the verticals lean, the couplers lie: closed, not flat
        s.q[i] = i <= loops ? 1.2 : 0;
        s.v[i] = i <= loops ? -1 : 0;
    }
    const int evals = 1 + EVALS / (4 * loops);
    for (int k = 0; k < BATCHES; k++) {
        batch[k] = time_tape(&s, evals) / evals * 1e9;
    }
    qsort(batch, BATCHES, sizeof *batch, ascending);
    hn_tape_info info = hn_accel_tape_info(s.accel);
    printf("%d,%d,%.4f,%d,%.1f,%d,%d,%.1f,%.1f\n", loops, s.n, s.compile_seconds, info.ops,
           (double)info.ops / loops, info.instructions, info.slots, batch[0] / loops,
           batch[BATCHES / 2] / loops);
    close_subject(&s);
    return 0;
}

int main(void) {
    if (bench_fb0()) {
        return 1;
    }
    static const int sizes[] = {1, 2, 5, 10, 20, 50, 100, 200};
    printf("loops,speeds,compile_s,ops,ops_per_loop,instructions,slots,ns_per_loop_min,ns_per_loop_"
           "median\n");
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        if (bench_ladder(sizes[k])) {
            return 1;
        }
    }
    return 0;
}
