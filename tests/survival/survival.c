// Which methods survive the flat poses of the ladder of N four-bars, as counts out of 200 step sizes. Prints the table that is
// kept in results.txt; arguments choose: survival [METHOD-PREFIX [N [STEPS]]]. See README.md.
#include "support/ladder.h"
#include "support/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 200 };
#define DURATION 10.0

typedef struct entry {
    const char *formulation, *stepper;
    int max_loops; ///< larger ladders are left out, for the time they take
} entry;

static const entry entries[] = {
    {"index1", "rk4", 40},
    {"baumgarte:alpha=10,beta=10", "rk4", 40},
    {"projection", "rk4", 40},
    {"projection:what=velocity", "rk4", 10},
    {"nullspace", "rk4", 10},
    {"partitioning", "rk4", 10},
    {"reduced", "rk4", 10},
    {"penalty", "rk4", 10},
    {"augmented-lagrangian", "rk4", 10},
    {"udwadia-kalaba", "rk4", 10},
};

static void run_entry(const hn_model *m, const hn_ladder_motion *motion, const entry *e,
                      int steps) {
    int count[HN_LADDER_ENDS] = {0};
    double worst = 0;
    for (int k = 0; k < steps; k++) {
        char method[HN_SPEC_MAX];
        double off = 0;
        snprintf(method, sizeof method, "%s@%s:h=%.17g", e->formulation, e->stepper,
                 hn_ladder_step(k, steps));
        hn_ladder_end end = hn_ladder_run(m, motion, method, &off);
        count[end]++;
        if (end == HN_LADDER_SURVIVED && off > worst) {
            worst = off;
        }
    }
    printf("%-2d  %-34s %-7s %4d of %d  %7d  %7d %5d %7d   %.1e\n", motion->n_loops, e->formulation,
           e->stepper, count[HN_LADDER_SURVIVED], steps, count[HN_LADDER_OFF],
           count[HN_LADDER_STOPPED], count[HN_LADDER_TOLD], count[HN_LADDER_SILENT], worst);
    fflush(stdout);
}

int main(int argc, char **argv) {
    static const int sizes[] = {1, 2, 10, 40};
    static hn_ladder_motion motion;
    const char *prefix = argc > 1 ? argv[1] : "";
    const int only = argc > 2 ? atoi(argv[2]) : 0, steps = argc > 3 ? atoi(argv[3]) : STEPS;
    printf("N   formulation                        stepper  survived       off  stopped  told  "
           "silent   "
           "largest error of the survivors [m]\n");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        if (only > 0 && sizes[i] != only) {
            continue;
        }
        char setting[16];
        hn_model m;
        snprintf(setting, sizeof setting, "N=%d", sizes[i]);
        hn_model_open_closed(&m, "n-four-bar", setting);
        hn_ladder_motion_fill(&motion, sizes[i], DURATION);
        for (size_t k = 0; k < sizeof entries / sizeof *entries; k++) {
            if (sizes[i] <= entries[k].max_loops &&
                strncmp(entries[k].formulation, prefix, strlen(prefix)) == 0) {
                run_entry(&m, &motion, &entries[k], steps);
            }
        }
        hn_model_close(&m);
    }
    return 0;
}
