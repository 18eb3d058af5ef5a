// SPDX-License-Identifier: GPL-3.0-or-later
// Survival of methods at the flat poses of the ladder of N four-bars: counts out of so many step
// sizes. Prints the table that is kept in results.txt; arguments choose: survival [METHOD-PREFIX [N
// [STEPS]]]. See README.md.
#include "support/ladder.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZES = 4 };
static const int sizes[SIZES] = {1, 2, 10, 40};
#define DURATION 10.0

typedef struct entry {
    const char *formulation, *stepper;
    /// step sizes that are tried on each ladder, fewer where a run is dear; 0: left out
    int steps[SIZES];
    int adaptive; ///< tolerances from 1e-3 to 1e-9 take the place of step sizes
} entry;

static const entry entries[] = {
    {"index1", "rk4", {200, 200, 200, 40}, 0},
    {"baumgarte:alpha=10,beta=10", "rk4", {200, 200, 200, 40}, 0},
    {"projection", "rk4", {200, 200, 200, 200}, 0},
    {"projection:what=velocity", "rk4", {200, 200, 200, 40}, 0},
    {"nullspace", "rk4", {200, 200, 40, 10}, 0},
    {"nullspace-as-printed", "rk4", {200, 200, 40, 10}, 0},
    {"partitioning", "rk4", {200, 200, 40, 10}, 0},
    {"reduced", "rk4", {200, 200, 40, 10}, 0},
    {"nullspace-solver", "rk4", {40, 40, 4, 0}, 0},
    {"symmetric-projection", "rk4", {40, 40, 40, 4}, 0},
    {"symmetric-projection", "midpoint", {40, 40, 10, 4}, 0},
    {"projection", "midpoint", {40, 40, 4, 0}, 0},
    {"projection", "gauss2", {40, 40, 10, 0}, 0},
    {"projection", "dopri5", {40, 40, 40, 10}, 1},
    {"penalty", "rk4", {200, 200, 40, 10}, 0},
    {"augmented-lagrangian", "rk4", {200, 200, 40, 10}, 0},
    {"udwadia-kalaba", "rk4", {200, 200, 40, 10}, 0},
    {"ali3p", "trapezoidal", {40, 40, 10, 4}, 0},
    {"ggl", "radau5", {40, 40, 10, 4}, 1},
    {"ggl", "genalpha", {40, 40, 4, 2}, 0},
    {"index3", "radau5", {40, 40, 10, 4}, 1},
    {"index3", "genalpha", {40, 40, 4, 2}, 0},
    {"index3", "hht", {40, 40, 4, 2}, 0},
    {"index3", "rattle", {40, 40, 4, 2}, 0},
    {"index2", "radau5", {40, 40, 4, 0}, 1},
    {"index2", "midpoint", {40, 40, 4, 0}, 0},
    {"index2", "hem3", {40, 40, 4, 0}, 0},
    {"index2", "hem4", {40, 40, 4, 2}, 0},
    {"index2", "half-explicit-rk4", {40, 40, 4, 0}, 0},
};

static void run_entry(const hn_model *m, const hn_ladder_motion *motion, const entry *e,
                      int steps) {
    int count[HN_SURVIVAL_ENDS] = {0};
    double worst = 0;
    for (int k = 0; k < steps; k++) {
        char method[HN_SPEC_MAX];
        double off = 0;
        snprintf(method, sizeof method, "%s@%s:%s=%.17g", e->formulation, e->stepper,
                 e->adaptive ? "rtol" : "h",
                 e->adaptive ? pow(10, -3 - 6.0 * k / (steps - 1)) : hn_ladder_step(k, steps));
        hn_survival_end end = hn_ladder_run(m, motion, method, &off);
        count[end]++;
        if (end == HN_SURVIVAL_SURVIVED && off > worst) {
            worst = off;
        }
    }
    printf("%-2d  %-34s %-17s %4d of %-3d  %7d  %7d %5d %7d   %.1e\n", motion->n_loops,
           e->formulation, e->stepper, count[HN_SURVIVAL_SURVIVED], steps, count[HN_SURVIVAL_OFF],
           count[HN_SURVIVAL_STOPPED], count[HN_SURVIVAL_TOLD], count[HN_SURVIVAL_SILENT], worst);
    fflush(stdout);
}

int main(int argc, char **argv) {
    static hn_ladder_motion motion;
    const char *prefix = argc > 1 ? argv[1] : "";
    const int only = argc > 2 ? atoi(argv[2]) : 0, most = argc > 3 ? atoi(argv[3]) : 200;
    printf("N   formulation                        stepper             survived        off  "
           "stopped  told  "
           "silent   "
           "largest error of the survivors [m]\n");
    for (int i = 0; i < SIZES; i++) {
        if (only > 0 && sizes[i] != only) {
            continue;
        }
        char setting[16];
        hn_model m;
        snprintf(setting, sizeof setting, "N=%d", sizes[i]);
        hn_model_open_closed(&m, "n-four-bar", setting);
        hn_ladder_motion_fill(&motion, sizes[i], DURATION);
        for (size_t k = 0; k < sizeof entries / sizeof *entries; k++) {
            const int steps = entries[k].steps[i] < most ? entries[k].steps[i] : most;
            if (steps > 0 && strncmp(entries[k].formulation, prefix, strlen(prefix)) == 0) {
                run_entry(&m, &motion, &entries[k], steps);
            }
        }
        hn_model_close(&m);
    }
    return 0;
}
