// SPDX-License-Identifier: GPL-3.0-or-later
// One evaluation of accelerations and multipliers: the reference four-bar FB0 through its tape
// beside the same equations written by hand for this one mechanism, and the ladder of N four-bars
// for its growth with N. Prints CSV.
//
// Every result feeds the next input, so that no evaluation can be hoisted or overlapped more than
// in a real step. Batches of the two alternate; the smallest is what the machine can do, the median
// what it did.
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

/// FB0 by hand: M, f, J, gamma and the saddle-point solve by elimination, straight-line.
__attribute__((noinline)) static void by_hand(const double *q, const double *w, double *a,
                                              double *lambda) {
    const double l1 = 1, l2 = 2, l3 = 1.8, m1 = 1, m2 = 2, m3 = 1.8, g = 9.81;
    const double k = m2 * l1 * l2 / 2, M11 = m1 * l1 * l1 / 3 + m2 * l1 * l1,
                 M22 = m2 * l2 * l2 / 3, M33 = m3 * l3 * l3 / 3;
    const double s1 = sin(q[0]), c1 = cos(q[0]), s2 = sin(q[1]), c2 = cos(q[1]), s3 = sin(q[2]),
                 c3 = cos(q[2]);
    const double w1 = w[0] * w[0], w2 = w[1] * w[1], w3 = w[2] * w[2];
    const double c12 = c1 * c2 + s1 * s2, s12 = s1 * c2 - c1 * s2, M12 = k * c12;
    const double f1 = -k * s12 * w2 - g * (m1 / 2 + m2) * l1 * c1,
                 f2 = k * s12 * w1 - g * m2 / 2 * l2 * c2, f3 = -g * m3 / 2 * l3 * c3;
    const double a1 = l1 * c1, b1 = l1 * s1, a2 = l2 * c2, b2 = l2 * s2, a3 = l3 * c3, b3 = l3 * s3;
    // J = [-b1 -b2 b3; a1 a2 -a3], gamma = [-a1 w1 - a2 w2 + a3 w3; -b1 w1 - b2 w2 + b3 w3]
    const double gx = a3 * w3 - a1 * w1 - a2 * w2, gy = b3 * w3 - b1 * w1 - b2 * w2;
    // M^-1 J', the two by two block of th1 and th2 by its inverse
    const double r = 1 / (M11 * M22 - M12 * M12), i11 = M22 * r, i12 = -M12 * r, i22 = M11 * r,
                 i33 = 1 / M33;
    const double x1 = -(i11 * b1 + i12 * b2), x2 = -(i12 * b1 + i22 * b2), x3 = i33 * b3;
    const double y1 = i11 * a1 + i12 * a2, y2 = i12 * a1 + i22 * a2, y3 = -i33 * a3;
    const double z1 = i11 * f1 + i12 * f2, z2 = i12 * f1 + i22 * f2, z3 = i33 * f3;
    const double Sxx = b3 * x3 - b1 * x1 - b2 * x2, Sxy = b3 * y3 - b1 * y1 - b2 * y2,
                 Syy = a1 * y1 + a2 * y2 - a3 * y3;
    const double rx = -gx - (b3 * z3 - b1 * z1 - b2 * z2), ry = -gy - (a1 * z1 + a2 * z2 - a3 * z3);
    const double d = 1 / (Sxx * Syy - Sxy * Sxy);
    lambda[0] = (Syy * rx - Sxy * ry) * d;
    lambda[1] = (Sxx * ry - Sxy * rx) * d;
    a[0] = z1 + x1 * lambda[0] + y1 * lambda[1];
    a[1] = z2 + x2 * lambda[0] + y2 * lambda[1];
    a[2] = z3 + x3 * lambda[0] + y3 * lambda[1];
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
        for (int i = 0; i < s->n; i++) {
            s->v[i] += 1e-12 * s->a[i];
        }
    }
    return seconds() - start;
}

static double time_hand(const double *q, double *v, double *a, double *lambda, int evals) {
    double start = seconds();
    for (int k = 0; k < evals; k++) {
        by_hand(q, v, a, lambda);
        for (int i = 0; i < 3; i++) {
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
    double v[3], a[3], lambda[2], tape[BATCHES], hand[BATCHES], worst = 0;
    for (int i = 0; i < 3; i++) {
        s.q[i] = start[i];
        s.v[i] = v[i] = start[3 + i];
    }
    for (int k = 0; k < BATCHES; k++) {
        tape[k] = time_tape(&s, EVALS) / EVALS * 1e9;
        hand[k] = time_hand(s.q, v, a, lambda, EVALS) / EVALS * 1e9;
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
