// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of a run beside hand-written C, all in one process: evaluation and Runge-Kutta step of
// the reference four-bar FB0, interpreted and native, without and with the watch that every run
// has, whole runs of the course's four-bar, and the ladder of 40, 200 and 1,000 loops beside a
// sweep along its loops by hand. Prints CSV: medians of batches that take turns, their quartiles,
// ratios.
#include "hand_fourbar.h"
#include "hand_ladder.h"

#include "base/clock.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/compile.h"
#include "dynamics/evaluate/accel_lanes.h"
#include "expr/native.h"
#include "study/ensemble/ensemble.h"
#include "study/run/run.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { BATCHES = 21, EVALS = 10000, STEPS = 500, SWEEP = 10000, SWEEP_STEPS = 50 };
static const double H = 1e-4;   // [s] step; BATCHES * STEPS of them stay clear of any dead point
static const double WHOLE = 10; // [s] whole runs
static const double START[6] = {1, 0.498324904142577, 1.516841745037813, 2, -0.3, 0.9};

static void give_up(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(3);
}

// ---- what is timed: each returns the seconds of one batch per item ----

typedef struct subject {
    const char *name, *code;
    double (*batch)(struct subject *);
    hn_system *sys;
    hn_accel *accel;
    hn_accel_lanes lanes;
    hn_run *run;
    hn_ensemble *ensemble;
    hn_arena *arena;
    double *q, *v, *a, *lambda;
    int n, evals;
    double t, sample[BATCHES];
} subject;

/// The next evaluation is at another state: angles that stay would be found once only.
static void move_on(int n, double *q, double *v, const double *a) {
    for (int i = 0; i < n; i++) {
        q[i] += 1e-12 * v[i];
        v[i] += 1e-12 * a[i];
    }
}

static double time_hand_ladder(subject *s) {
    const int loops = s->n / 2;
    const double start = hn_clock_thread();
    for (int k = 0; k < s->evals; k++) {
        hn_hand_ladder(loops, s->q, s->v, s->a, s->lambda);
        move_on(s->n, s->q, s->v, s->a);
    }
    return (hn_clock_thread() - start) / s->evals;
}

static double time_hand(subject *s) {
    static double q[3] = {1, 0.498324904142577, 1.516841745037813}, v[3] = {2, -0.3, 0.9};
    double a[3], lambda[2];
    (void)s;
    const double start = hn_clock_thread();
    for (int k = 0; k < EVALS; k++) {
        hn_hand_fourbar(q, v, a, lambda);
        move_on(3, q, v, a);
    }
    return (hn_clock_thread() - start) / EVALS;
}

/// As an integrator calls it: it asks for the answer alone.
static double time_accel(subject *s) {
    const long long fallbacks = hn_accel_fallbacks(s->accel);
    const double start = hn_clock_thread();
    for (int k = 0; k < s->evals; k++) {
        if (hn_accel_eval(s->accel, 0, s->q, s->v, 0, 0, s->a, s->lambda, NULL) != HN_OK) {
            give_up(s->name, "there is no answer");
        }
        move_on(s->n, s->q, s->v, s->a);
    }
    const double each = (hn_clock_thread() - start) / s->evals;
    if (hn_accel_fallbacks(s->accel) != fallbacks) {
        give_up(s->name, "the tape did not answer");
    }
    return each;
}

/// A block of lanes at states of their own; the time is that of one of them.
static double time_lanes(subject *s) {
    hn_accel_lanes *l = &s->lanes;
    const int blocks = s->evals / HN_LANES;
    const double start = hn_clock_thread();
    for (int k = 0; k < blocks; k++) {
        if (hn_accel_lanes_eval(l) != (hn_lane_bits)-1) {
            give_up(s->name, "not every lane has an answer");
        }
        for (int i = 0; i < s->n; i++) {
            const double *a = hn_accel_lanes_a(l, i);
            for (int lane = 0; lane < HN_LANES; lane++) {
                l->v[HN_LANES * i + lane] += 1e-12 * a[lane];
            }
        }
    }
    return (hn_clock_thread() - start) / (blocks * HN_LANES);
}

/// The classical Runge-Kutta step by hand.
__attribute__((noinline)) static void hand_step(double *y) {
    static const double c[4] = {0, 0.5, 0.5, 1}, w[4] = {1, 2, 2, 1};
    double k[4][6], lambda[2];
    for (int s = 0; s < 4; s++) {
        double at[6];
        for (int i = 0; i < 6; i++) {
            at[i] = s ? y[i] + H * c[s] * k[s - 1][i] : y[i];
        }
        for (int i = 0; i < 3; i++) {
            k[s][i] = at[3 + i];
        }
        hn_hand_fourbar(at, at + 3, k[s] + 3, lambda);
    }
    for (int i = 0; i < 6; i++) {
        y[i] += H / 6 * (w[0] * k[0][i] + w[1] * k[1][i] + w[2] * k[2][i] + w[3] * k[3][i]);
    }
}

static double time_hand_step(subject *s) {
    const double start = hn_clock_thread();
    for (int k = 0; k < STEPS; k++) {
        hand_step(s->q);
    }
    return (hn_clock_thread() - start) / STEPS;
}

static double time_run(subject *s) {
    s->t += STEPS * H;
    const double start = hn_clock_thread();
    if (hn_run_advance(s->run, s->t) != HN_OK) {
        give_up(s->name, hn_run_get_summary(s->run).reason);
    }
    return (hn_clock_thread() - start) / STEPS;
}

/// A sweep of so many runs from starts of their own, in one thread; the time is that of a step.
static double time_sweep(subject *s) {
    static double q[SWEEP * 3], v[SWEEP * 3], q_end[SWEEP * 3], v_end[SWEEP * 3];
    static hn_ensemble_start starts[SWEEP];
    static hn_ensemble_end ends[SWEEP];
    for (int k = 0; k < SWEEP; k++) {
        for (int i = 0; i < 3; i++) {
            q[3 * k + i] = START[i];
            v[3 * k + i] = START[3 + i] * (1 + 1e-5 * k);
        }
        starts[k] = hn_ensemble_start_of(s->ensemble, q + 3 * (size_t)k, v + 3 * (size_t)k);
    }
    const double start = hn_clock_thread();
    hn_ensemble_run(s->ensemble, SWEEP, starts, SWEEP_STEPS * H, q_end, v_end, ends);
    const double each = (hn_clock_thread() - start) / (SWEEP * (double)SWEEP_STEPS);
    for (int k = 0; k < SWEEP; k++) {
        if (ends[k].status != HN_OK || ends[k].steps != SWEEP_STEPS || ends[k].in_doubt > 0) {
            give_up(s->name, "a run of the sweep did not come to its end in lanes");
        }
    }
    return each;
}

/// A whole run from the start, beginning included.
static double time_whole(subject *s) {
    const double start = hn_clock_thread();
    if (hn_run_reset(s->run) != HN_OK || hn_run_advance(s->run, WHOLE) != HN_OK) {
        give_up(s->name, hn_run_get_summary(s->run).reason);
    }
    return hn_clock_thread() - start;
}

/// As many steps as the classical method needs there; how long they are does not cost.
static double time_hand_whole(subject *s) {
    const double start = hn_clock_thread();
    for (int k = 0; k < 2000; k++) { // steps of 5 ms have an error of 8e-6 rad
        hand_step(s->q);
    }
    return hn_clock_thread() - start;
}

// ---- making them ----

static hn_system *compile(const char *path, const hn_setting *setting) {
    hn_diags diags = {0};
    hn_scene *scene = NULL; // kept to the end: the system looks into it
    hn_system *sys = NULL;
    if (hn_scene_load_file(path, setting, setting ? 1 : 0, &scene, &diags) != HN_OK ||
        hn_system_compile(scene, NULL, &sys, &diags) != HN_OK) {
        give_up(path, diags.item[0].message);
    }
    return sys;
}

static void make_arrays(subject *s) {
    const hn_system_info info = hn_system_get_info(s->sys);
    s->arena = hn_arena_create(0);
    s->n = info.nv;
    double **arrays[] = {&s->q, &s->v, &s->a};
    for (int i = 0; i < 3; i++) {
        *arrays[i] = hn_arena_doubles(s->arena, (size_t)info.nq + (size_t)info.nv);
    }
    s->lambda = hn_arena_doubles(s->arena, (size_t)info.nc + 1);
}

/// Arrays and a state: that of FB0; the bars of a ladder lean, each at an angle of its own.
static void make_state(subject *s) {
    make_arrays(s);
    const int loops = s->n / 2;
    for (int i = 0; i < s->n; i++) {
        s->q[i] = s->n == 3 ? START[i] : (i <= loops ? 1.2 : 0.2) + 1e-3 * (i % 100);
        s->v[i] = s->n == 3 ? START[3 + i] : i <= loops ? -1 : 0.5;
    }
    s->evals = s->n == 3 ? EVALS : EVALS / loops;
}

/// Tapes compiled natively are those made while the service is not suspended.
static void make_accel(subject *s, int native) {
    const hn_accel_opts opts = {.want_lambda = 1};
    make_state(s);
    if (!native) {
        hn_native_suspend();
    }
    if (hn_accel_create(s->sys, &opts, s->arena, &s->accel) != HN_OK) {
        give_up(s->name, "no solver");
    }
    if (!native) {
        hn_native_resume();
    }
}

static void make_lanes(subject *s, hn_lanes_set set) {
    make_accel(s, 0);
    if (hn_accel_lanes_create(s->accel, set, s->arena, &s->lanes) != HN_OK) {
        give_up(s->name, "no lanes");
    }
    for (int i = 0; i < s->n * HN_LANES; i++) {
        s->lanes.q[i] = s->q[i / HN_LANES];
        s->lanes.v[i] = s->v[i / HN_LANES] * (1 + 0.01 * (i % HN_LANES));
    }
}

static void make_run(subject *s, const char *formulation, int native, int watched) {
    char text[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    make_arrays(s);
    snprintf(text, sizeof text, "%s@rk4:h=1e-4", formulation);
    if (!native) {
        hn_native_suspend();
    }
    if (hn_method_parse(text, &spec, &diag) != HN_OK ||
        hn_run_create(s->sys, &spec, START, START + 3, NULL, &s->run, &diag) != HN_OK) {
        give_up(text, diag.message);
    }
    if (!native) {
        hn_native_resume();
    }
    hn_run_watch(s->run, watched);
}

static void make_sweep(subject *s) {
    hn_ensemble_opts opts = hn_ensemble_opts_default();
    hn_method_spec spec;
    hn_diag diag = {0};
    opts.threads = 1;
    if (hn_method_parse("index1@rk4:h=1e-4", &spec, &diag) != HN_OK ||
        hn_ensemble_create(s->sys, &spec, &opts, &s->ensemble, &diag) != HN_OK) {
        give_up(s->name, diag.message);
    }
}

// ---- the table ----

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Batches in turn, so that whatever slows the machine slows all of them.
static void measure(subject *s, int n) {
    for (int i = 0; i < n; i++) { // native tapes are compiled after their first runs
        s[i].batch(&s[i]);
    }
    hn_native_wait();
    for (int k = 0; k < BATCHES; k++) {
        for (int i = 0; i < n; i++) {
            s[i].sample[k] = 1e9 * s[i].batch(&s[i]);
        }
    }
    for (int i = 0; i < n; i++) {
        qsort(s[i].sample, BATCHES, sizeof *s[i].sample, ascending);
    }
}

/// Each row beside the one it is compared with, `base`.
static void print(const subject *s, int n, int base) {
    const double beside = s[base].sample[BATCHES / 2];
    for (int i = 0; i < n; i++) {
        const double *x = s[i].sample;
        printf("%s,%s,%.1f,%.1f,%.1f,%.2f\n", s[i].name, s[i].code, x[BATCHES / 2], x[BATCHES / 4],
               x[3 * BATCHES / 4], x[BATCHES / 2] / beside);
    }
}

static void bench_evaluation(hn_system *sys) {
    subject s[] = {
        {.name = "fb0 evaluation", .code = "hand", .batch = time_hand},
        {.name = "fb0 evaluation", .code = "interpreter", .batch = time_accel, .sys = sys},
        {.name = "fb0 evaluation", .code = "native", .batch = time_accel, .sys = sys},
        {.name = "fb0 evaluation", .batch = time_lanes, .sys = sys},
        {.name = "fb0 evaluation", .batch = time_lanes, .sys = sys},
        {.name = "fb0 evaluation", .batch = time_lanes, .sys = sys}};
    static const char *const codes[] = {"32 lanes plain", "32 lanes avx2", "32 lanes avx512"};
    const int n = 4 + (int)hn_lanes_set_best();
    make_accel(&s[1], 0);
    make_accel(&s[2], 1);
    for (int i = 3; i < n; i++) { // each instruction set that the processor has
        s[i].code = codes[i - 3];
        make_lanes(&s[i], (hn_lanes_set)(i - 3));
    }
    measure(s, n);
    print(s, n, 0);
}

static void bench_steps(hn_system *sys) {
    static const char *const formulations[] = {"index1", "projection", "reduced"};
    static const char *const codes[] = {"interpreter", "native", "interpreter watched",
                                        "native watched"};
    enum { N_RUNS = 1 + 3 * 4, N = N_RUNS + 1 };
    subject s[N] = {{.name = "fb0 rk4 step", .code = "hand", .batch = time_hand_step}};
    double y[6];
    for (int i = 0; i < 6; i++) {
        y[i] = START[i];
    }
    s[0].q = y;
    for (int i = 1; i < N_RUNS; i++) {
        const int f = (i - 1) / 4, code = (i - 1) % 4;
        static char names[N_RUNS][64];
        snprintf(names[i], sizeof names[i], "fb0 %s@rk4 step", formulations[f]);
        s[i] = (subject){.name = names[i], .code = codes[code], .batch = time_run, .sys = sys};
        make_run(&s[i], formulations[f], code % 2, code / 2);
    }
    s[N_RUNS] = (subject){.name = "fb0 index1@rk4 step",
                          .code = "10000 runs in lanes",
                          .batch = time_sweep,
                          .sys = sys};
    make_sweep(&s[N_RUNS]);
    measure(s, N);
    print(s, N, 0);
}

/// Runs over 10 s with an error of about 1e-5 rad, stepping alone and watched; beside RK4 by hand.
static void bench_whole(hn_system *sys) {
    static const char *const methods[] = {"index1@dop853:rtol=1e-7", "projection@dop853:rtol=1e-7",
                                          "index1@rk4:h=5e-3"};
    enum { N = 1 + 2 * 3 };
    subject s[N] = {{.name = "10 s of the four-bar", .code = "hand", .batch = time_hand_whole}};
    double y[6], q[8], v[8], a[8], lambda[8];
    hn_assembly assembly;
    hn_diags diags = {0};
    for (int i = 0; i < 6; i++) {
        y[i] = START[i];
    }
    s[0].q = y;
    if (hn_assemble(sys, 0, q, v, a, lambda, &assembly, &diags) != HN_OK) {
        give_up("four-bar", diags.item[0].message);
    }

    // each twice: without and with the watch
    for (int i = 1; i < N; i++) {
        hn_method_spec spec;
        hn_diag diag = {0};
        s[i] = (subject){.name = methods[(i - 1) / 2],
                         .code = i % 2 ? "native whole run" : "native watched whole run",
                         .batch = time_whole};
        if (hn_method_parse(s[i].name, &spec, &diag) != HN_OK ||
            hn_run_create(sys, &spec, q, v, NULL, &s[i].run, &diag) != HN_OK) {
            give_up(s[i].name, diag.message);
        }
        hn_run_watch(s[i].run, i % 2 == 0);
    }
    measure(s, N);
    print(s, N, 0);
}

/// By hand, and through the engine: the same accelerations and multipliers.
static void compare_ladders(const subject *hand, subject *ours) {
    static double a[2 * HN_HAND_LADDER_MOST + 1], lambda[2 * HN_HAND_LADDER_MOST];
    const int loops = hand->n / 2;
    double most = 0, apart = 0;
    hn_hand_ladder(loops, ours->q, ours->v, a, lambda);
    if (hn_accel_eval(ours->accel, 0, ours->q, ours->v, 0, 0, ours->a, ours->lambda, NULL) !=
        HN_OK) {
        give_up(ours->name, "there is no answer");
    }
    for (int i = 0; i < hand->n; i++) {
        most = fmax(most, fabs(a[i]));
        apart = fmax(apart, fabs(a[i] - ours->a[i]));
    }
    for (int i = 0; i < 2 * loops; i++) {
        most = fmax(most, fabs(lambda[i]));
        apart = fmax(apart, fabs(lambda[i] - ours->lambda[i]));
    }
    if (!(apart <= 1e-9 * most)) { // rounding grows with the number of loops
        give_up(ours->name, "it differs from the one by hand");
    }
}

static void bench_ladder(int loops) {
    char name[32];
    snprintf(name, sizeof name, "ladder of %d", loops);
    hn_system *sys =
        compile("lessons/01-closed-loops/scenes/n-four-bar.json", &(hn_setting){"N", loops});
    subject s[] = {{.name = name, .code = "hand", .batch = time_hand_ladder, .sys = sys},
                   {.name = name, .code = "interpreter", .batch = time_accel, .sys = sys},
                   {.name = name, .code = "native", .batch = time_accel, .sys = sys}};
    const int n = loops < HN_HAND_LADDER_MOST ? 3 : 2; // the longest stays with the interpreter
    make_state(&s[0]);
    for (int i = 1; i < n; i++) {
        make_accel(&s[i], i == 2);
    }
    compare_ladders(&s[0], &s[1]);
    measure(s, n);
    print(s, n, 0);
}

int main(void) {
    char folder[] = "/tmp/holonom-bench-XXXXXX", pattern[64], why[HN_DIAG_MESSAGE];
    glob_t files;
    hn_native_opts opts = hn_native_opts_default(mkdtemp(folder));
    opts.look_after = opts.build_after = 0;
    opts.time_limit = 600; // on a busy machine
    hn_native_start(&opts);
    hn_system *sys = compile("lessons/01-closed-loops/scenes/fb0.json", NULL),
              *four_bar = compile("lessons/01-closed-loops/scenes/four-bar.json", NULL);
    printf("case,code,ns_median,ns_quartile_1,ns_quartile_3,ratio_to_first_row\n");
    bench_evaluation(sys);
    bench_steps(sys);
    bench_whole(four_bar);
    for (int k = 0; k < 3; k++) {
        bench_ladder((const int[]){40, 200, HN_HAND_LADDER_MOST}[k]);
    }
    hn_native_reason(why);
    if (why[0]) {
        give_up("native code", why);
    }

    // what was compiled for this table goes
    hn_native_stop();
    snprintf(pattern, sizeof pattern, "%s/*", folder);
    if (glob(pattern, 0, NULL, &files) == 0) {
        for (size_t i = 0; i < files.gl_pathc; i++) {
            unlink(files.gl_pathv[i]);
        }
        globfree(&files);
    }
    return rmdir(folder);
}
