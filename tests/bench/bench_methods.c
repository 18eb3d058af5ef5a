// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the classical Runge-Kutta method under each formulation on the ladder of N four-bars:
// operations and time for each loop, which should not depend on N. Prints CSV.
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/compile.h"
#include "study/run/run.h"

#include <stdio.h>

enum { STEPS = 50 };

static int bench(const hn_system *sys, const double *q, const double *v, const char *formulation,
                 int loops) {
    char text[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    snprintf(text, sizeof text, "%s@rk4:h=1e-3", formulation);
    if (hn_method_parse(text, &spec, &diag) != HN_OK ||
        hn_run_create(sys, &spec, q, v, NULL, &run, &diag) != HN_OK) {
        fprintf(stderr, "%s: %s\n", text, diag.message);
        return 1;
    }
    hn_run_watch(run, 0);
    const hn_status status = hn_run_advance(run, STEPS * 1e-3);
    const hn_run_summary s = hn_run_get_summary(run);
    const double each = (double)s.steps * loops;
    printf("%s,%d,%.1f,%.1f,%lld,%s\n", formulation, loops, s.cost.ops / each,
           s.cpu_seconds / each * 1e9, s.cost.fallbacks, hn_status_name(status));
    hn_run_free(run);
    return status != HN_OK;
}

static int bench_size(int loops) {
    static const char *const formulations[] = {
        "index1",  "baumgarte", "projection",           "nullspace",     "partitioning",
        "reduced", "penalty",   "augmented-lagrangian", "udwadia-kalaba"};
    const hn_setting setting = {"N", loops};
    const hn_system_opts opts = hn_system_opts_default();
    hn_diags diags = {0};
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    hn_arena *arena = hn_arena_create(0);
    hn_assembly assembly;
    int failed = 1;
    if (arena &&
        hn_scene_load_file("lessons/01-closed-loops/scenes/n-four-bar.json", &setting, 1, &scene,
                           &diags) == HN_OK &&
        hn_system_compile(scene, &opts, &sys, &diags) == HN_OK) {
        const hn_system_info info = hn_system_get_info(sys);
        double *q = hn_arena_doubles(arena, (size_t)info.nq);
        double *v = hn_arena_doubles(arena, (size_t)info.nv);
        double *a = hn_arena_doubles(arena, (size_t)info.nv);
        double *lambda = hn_arena_doubles(arena, (size_t)info.nc);
        failed = hn_assemble(sys, 0, q, v, a, lambda, &assembly, &diags) != HN_OK;
        for (size_t k = 0; !failed && k < sizeof formulations / sizeof *formulations; k++) {
            const int dense = k + 1 == sizeof formulations / sizeof *formulations;
            failed = !(dense && loops > 50) && bench(sys, q, v, formulations[k], loops);
        }
    }
    hn_system_free(sys);
    hn_scene_free(scene);
    hn_arena_free(arena);
    return failed;
}

int main(void) {
    static const int sizes[] = {10, 50, 200};
    printf("formulation,loops,ops_per_loop_and_step,ns_per_loop_and_step,fallbacks,status\n");
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        if (bench_size(sizes[k])) {
            return 1;
        }
    }
    return 0;
}
