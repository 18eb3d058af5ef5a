// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/timing.h"

#include "base/clock.h"

#include <math.h>
#include <stdlib.h>

int hn_timing_batch(hn_run *run, double T, double first_cpu, const hn_walk_limits *limits,
                    double *seconds, double *load) {
    const int n = (int)fmin(1e6, ceil(HN_TIMING_BATCH / fmax(1e-8, first_cpu)));
    double cpu = 0, wall = 0;
    for (int i = 0; i < n || cpu < HN_TIMING_BATCH; i++) {
        if (hn_run_reset(run) != HN_OK) {
            return 0;
        }
        const double w = hn_clock_wall(), c = hn_clock_thread();
        // straight through: clocks between steps would be part of what is measured
        const hn_status status = hn_run_advance(run, T);
        cpu += hn_clock_thread() - c + hn_run_get_summary(run).cost.elsewhere;
        wall += hn_clock_wall() - w;
        *seconds = cpu / (i + 1);
        if (status != HN_OK || (limits->stop && limits->stop(limits->user))) {
            return 0;
        }
    }
    *load = wall / cpu;
    return 1;
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void hn_timing_sort(double *list, int n) {
    qsort(list, (size_t)n, sizeof *list, by_size);
}

double hn_timing_quantile(const double *sorted, int n, double share) {
    const double at = share * (n - 1);
    const int i = (int)floor(at);
    return i + 1 < n ? sorted[i] + (at - i) * (sorted[i + 1] - sorted[i]) : sorted[n - 1];
}
