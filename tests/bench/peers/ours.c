// SPDX-License-Identifier: GPL-3.0-or-later
// FB0 over 10 s by the engine (whole watched runs, native tapes) and by libraries that get the
// hand-written accelerations. Prints CSV: program, method, setting, seconds, crank angle at the
// end. The least of the repeats is printed: what disturbs a run only adds to it.
#include "../hand_fourbar.h"

#include "base/clock.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/compile.h"
#include "expr/native.h"
#include "study/run/run.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double END = 10; // [s]
static int repeats = 5;
static double start[6]; // th1, th2, th3 from the x axis, and their rates

static void give_up(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(3);
}

// ---- the engine ----

static hn_system *sys;
static double q0[8], v0[8];

static void open_scene(const char *path) {
    static double a[8], lambda[8];
    hn_diags diags = {0};
    hn_scene *scene = NULL; // kept to the end: the system looks into it
    hn_assembly assembly;
    if (hn_scene_load_file(path, NULL, 0, &scene, &diags) != HN_OK ||
        hn_system_compile(scene, NULL, &sys, &diags) != HN_OK ||
        hn_assemble(sys, 0, q0, v0, a, lambda, &assembly, &diags) != HN_OK) {
        give_up(path, diags.item[0].message);
    }
}

static double run_once(const char *method, double *angle) {
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_sample sample;
    if (hn_method_parse(method, &spec, &diag) != HN_OK ||
        hn_run_create(sys, &spec, q0, v0, NULL, &run, &diag) != HN_OK) {
        give_up(method, diag.message);
    }
    const double begin = hn_clock_thread();
    const hn_status status = hn_run_advance(run, END);
    const double seconds = hn_clock_thread() - begin;
    *angle = status == HN_OK && hn_run_sample(run, END, &sample) == HN_OK ? sample.q[0] : HUGE_VAL;
    hn_run_free(run);
    return seconds;
}

static void time_engine(const char *form, const double *settings, int n) {
    for (int k = 0; k < n; k++) {
        char method[96];
        double angle = 0, least = HUGE_VAL;
        snprintf(method, sizeof method, form, settings[k]);
        for (int i = 0; i <= repeats; i++) {
            const double seconds = run_once(method, &angle);
            if (i == 0) {
                hn_native_wait(); // the first run asks for native tapes
            } else {
                least = fmin(least, seconds);
            }
        }
        printf("holonom,%.*s,%g,%.9g,%.17g\n", (int)(strcspn(method, ":")), method, settings[k],
               least, angle);
    }
}

// ---- libraries on hand-written accelerations ----

static int rhs(double t, const double y[], double ydot[], void *user) {
    double lambda[2];
    (void)t;
    (void)user;
    for (int i = 0; i < 3; i++) {
        ydot[i] = y[3 + i];
    }
    hn_hand_fourbar(y, y + 3, ydot + 3, lambda);
    return GSL_SUCCESS;
}

/// The classical Runge-Kutta method by hand, fixed step.
static double hand_rk4(double h, double *angle) {
    static const double c[4] = {0, 0.5, 0.5, 1}, w[4] = {1, 2, 2, 1};
    double y[6], k[4][6];
    memcpy(y, start, sizeof y);
    for (long n = lround(END / h); n > 0; n--) {
        for (int s = 0; s < 4; s++) {
            double at[6];
            for (int i = 0; i < 6; i++) {
                at[i] = s ? y[i] + h * c[s] * k[s - 1][i] : y[i];
            }
            rhs(0, at, k[s], NULL);
        }
        for (int i = 0; i < 6; i++) {
            y[i] += h / 6 * (w[0] * k[0][i] + w[1] * k[1][i] + w[2] * k[2][i] + w[3] * k[3][i]);
        }
    }
    *angle = y[0];
    return 0;
}

static double gsl_rk8pd(double tolerance, double *angle) {
    gsl_odeiv2_system system = {rhs, NULL, 6, NULL};
    gsl_odeiv2_driver *d =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3, tolerance, tolerance);
    double y[6], t = 0;
    memcpy(y, start, sizeof y);
    *angle = gsl_odeiv2_driver_apply(d, &t, END, y) == GSL_SUCCESS ? y[0] : HUGE_VAL;
    gsl_odeiv2_driver_free(d);
    return 0;
}

static int residual(sunrealtype t, N_Vector y, N_Vector ydot, N_Vector rest, void *user) {
    double f[6];
    const double *slope = N_VGetArrayPointer(ydot);
    double *r = N_VGetArrayPointer(rest);
    rhs(t, N_VGetArrayPointer(y), f, user);
    for (int i = 0; i < 6; i++) {
        r[i] = slope[i] - f[i];
    }
    return 0;
}

static double ida(double tolerance, double *angle) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context) != 0) {
        give_up("ida", "no context");
    }
    N_Vector y = N_VNew_Serial(6, context), ydot = N_VNew_Serial(6, context);
    memcpy(N_VGetArrayPointer(y), start, sizeof start);
    rhs(0, start, N_VGetArrayPointer(ydot), NULL);
    SUNMatrix A = SUNDenseMatrix(6, 6, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, A, context);
    void *mem = IDACreate(context);
    sunrealtype t = 0;
    const int failed = IDAInit(mem, residual, 0, y, ydot) ||
                       IDASStolerances(mem, tolerance, tolerance) ||
                       IDASetLinearSolver(mem, solver, A) || IDASetMaxNumSteps(mem, 1000000) ||
                       IDASetStopTime(mem, END) || IDASolve(mem, END, &t, y, ydot, IDA_NORMAL) < 0;
    *angle = failed ? HUGE_VAL : N_VGetArrayPointer(y)[0];
    IDAFree(&mem);
    SUNLinSolFree(solver);
    SUNMatDestroy(A);
    N_VDestroy(y);
    N_VDestroy(ydot);
    SUNContext_Free(&context);
    return 0;
}

static void time_library(const char *program, const char *method, double (*solve)(double, double *),
                         const double *settings, int n) {
    for (int k = 0; k < n; k++) {
        double angle = 0, least = HUGE_VAL;
        for (int i = 0; i < repeats; i++) {
            const double begin = hn_clock_thread();
            solve(settings[k], &angle);
            least = fmin(least, hn_clock_thread() - begin);
        }
        printf("%s,%s,%g,%.9g,%.17g\n", program, method, settings[k], least, angle);
    }
}

#define LADDER(...) \
    (const double[]){__VA_ARGS__}, (int)(sizeof((double[]){__VA_ARGS__}) / sizeof(double))

int main(int argc, char **argv) {
    char folder[] = "/tmp/holonom-peers-XXXXXX";
    if (argc < 8) {
        give_up("ours", "usage: ours SCENE.json th1 a2 th3 w1 wa2 w3");
    }
    for (int i = 0; i < 6; i++) { // a2 = th2 - th1
        start[i] = atof(argv[2 + i]) + (i % 3 == 1 ? start[i - 1] : 0);
    }
    hn_native_opts opts = hn_native_opts_default(mkdtemp(folder));
    opts.look_after = opts.build_after = 0;
    hn_native_start(&opts);
    open_scene(argv[1]);

    time_engine("index1@rk4:h=%g", LADDER(1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4));
    time_engine("projection@rk4:h=%g", LADDER(1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4));
    time_engine("index1@dop853:rtol=%g", LADDER(1e-4, 1e-6, 1e-8, 1e-10, 1e-12));
    time_engine("projection@dop853:rtol=%g", LADDER(1e-4, 1e-6, 1e-8, 1e-10, 1e-12));
    time_engine("ggl@radau5:rtol=%g", LADDER(1e-4, 1e-6, 1e-8, 1e-10));

    time_library("hand-written C", "rk4", hand_rk4, LADDER(1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4));
    time_library("GSL", "rk8pd", gsl_rk8pd, LADDER(1e-4, 1e-6, 1e-8, 1e-10, 1e-12));
    time_library("SUNDIALS", "IDA", ida, LADDER(1e-4, 1e-6, 1e-8, 1e-10, 1e-12));
    hn_native_stop();
    return hn_system_get_info(sys).nv == 3 ? 0 : 3;
}
