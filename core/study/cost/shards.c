// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/shards.h"

#include "study/run/timing.h"

#include <math.h>
#include <stdlib.h>

static const double EVALUATION = 1e-7; // per speed: small mechanisms need 0.2 to 1 us in all [s]
static const double ITERATED = 6; // evaluations per stage of an integrator that solves for them
static const double LOOSEST_RTOL = 1e-3;
static const double LONGEST_STEP = 0.5; // chosen at the loosest tolerance, times the largest rate

/// Accepted steps of a point: counted for fixed ones, by the order for chosen ones.
static double expected_steps(const hn_wp *wp, const hn_wp_method *m, double size) {
    if (!m->adaptive) {
        return wp->ref->T / size;
    }
    const double order = fmax(1, m->spec.stepper->order);
    return fmax(1, wp->ref->T * wp->ref->scales.rate / LONGEST_STEP *
                       pow(LOOSEST_RTOL / size, 1 / order));
}

double hn_wp_expected_seconds(const hn_wp *wp, int m, int k) {
    const hn_wp_method *method = &wp->methods[m];
    const hn_stepper *stepper = method->spec.stepper;
    const double stages = fmax(1, stepper->stages) * (stepper->dae ? ITERATED : 1);
    const double cpu = expected_steps(wp, method, method->point[k].size) * stages * EVALUATION *
                       fmax(1, hn_system_get_info(wp->sys).nv);
    // with looks, warm-up, and the samples
    return 2 * cpu + fmax(0, wp->opts.n_samples) * fmax(HN_TIMING_BATCH, cpu);
}

typedef struct load {
    double seconds;
    int index;
} load;

/// Compares by cost, expensive points first. Equal ones keep the order of the study, so that the
/// result does not depend on the sorting algorithm.
static int dearest_first(const void *a, const void *b) {
    const load *x = a, *y = b;
    if (x->seconds != y->seconds) {
        return x->seconds < y->seconds ? 1 : -1;
    }
    return x->index - y->index;
}

void hn_wp_split(const hn_wp *wp, int n, int *shard) {
    load list[HN_WP_SHARDS];
    double sum[HN_WP_SHARDS] = {0};
    const int n_points = wp->n_methods * wp->n_levels;
    HN_ASSERT(n >= 1 && n <= HN_WP_SHARDS);
    for (int i = 0; i < n_points; i++) {
        list[i] = (load){hn_wp_expected_seconds(wp, i / wp->n_levels, i % wp->n_levels), i};
    }
    qsort(list, (size_t)n_points, sizeof *list, dearest_first);
    for (int i = 0; i < n_points; i++) {
        int least = 0;
        for (int j = 1; j < n; j++) {
            least = sum[j] < sum[least] ? j : least;
        }
        sum[least] += list[i].seconds;
        shard[list[i].index] = least + 1;
    }
}
