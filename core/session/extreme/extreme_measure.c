// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_measure.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_quantity.h"
#include "session/extreme/extreme_solve.h"
#include "session/extreme/extreme_stable.h"
#include "session/extreme/extreme_verdict.h"
#include "session/extreme/extreme_walk.h"

#include "study/cost/convergence.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static bool fits(const hn_extreme_expect *e, const char *word, const char *reason) {
    const int same = strcmp(e->word, word) == 0 ||
                     (strcmp(e->word, "ended") == 0 && strcmp(word, "finished") != 0);
    return same && (!e->says || strstr(reason, e->says));
}

/// Returns how the run (or the solve) of one point ended, with the reason.
static hn_status end_of(hn_extreme_bench *bench, const hn_extreme_point *point, char reason[200]) {
    if (point->trial->solvers) {
        hn_extreme_answer answer;
        hn_extreme_solve(bench, point, &answer);
        snprintf(reason, 200, "%s", answer.reason);
        return answer.status;
    }
    hn_extreme_check look;
    hn_extreme_check_begin(bench, point, HN_EXTREME_WATCHED, &look);
    const hn_status status = look.status;
    if (status != HN_OK && look.run) {
        snprintf(reason, 200, "at %.4g s: %.180s", look.summary.t, look.reason);
    } else {
        snprintf(reason, 200, "%s", look.reason);
    }
    hn_extreme_check_end(&look);
    return status;
}

/// Gives the common outcome of all points of the sweep, or the first that differs from the
/// prediction; value is the share of points with the predicted outcome.
static void see_outcome(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                        const hn_extreme_scene *scene, const char *method, hn_extreme_seen *out) {
    const int n = trial->n_sweep > 0 ? trial->n_sweep : 1;
    int good = 0;
    for (int i = 0; i < n; i++) {
        const hn_extreme_point point = {trial, scene, method, trial->values[i]};
        char reason[200] = "";
        const hn_status status = end_of(bench, &point, reason);
        const char *word = hn_extreme_outcome(status);
        const int as_expected = fits(&trial->expect, word, reason);
        if (hn_extreme_is_stopped(bench)) {
            out->value = (double)NAN;
            return;
        }
        if (i == 0 || (good == i && !as_expected)) {
            snprintf(out->word, sizeof out->word, "%s", word);
            snprintf(out->reason, sizeof out->reason, "%s", reason);
        }
        good += as_expected;
    }
    out->value = (double)good / n;
}

// numbers ----

/// Measures the quantity at every value of the sweep. Returns 0, with a reason in out, when one is
/// missing.
static bool see_sweep(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                      const hn_extreme_scene *scene, const char *method, hn_extreme_seen *out,
                      double *y) {
    for (int i = 0; i < trial->n_sweep; i++) {
        const hn_extreme_point point = {trial, scene, method, trial->values[i]};
        char reason[200];
        hn_status status;
        y[i] = hn_extreme_quantity_of(bench, &point, reason, &status);
        if (isnan(y[i])) {
            snprintf(out->reason, sizeof out->reason, "%.40s = %g: %.140s", trial->sweep,
                     trial->values[i], reason);
            out->value = (double)NAN;
            return false;
        }
    }
    return true;
}

static void see_value(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                      const hn_extreme_scene *scene, const char *method, hn_extreme_seen *out) {
    const hn_extreme_point point = {trial, scene, method, 0};
    hn_status status;
    out->value = hn_extreme_quantity_of(bench, &point, out->reason, &status);
}

static double reduce_exponent(const double *x, const double *y, int n) {
    return hn_fit_order(n, x, y);
}
static double reduce_ratio(const double *x, const double *y, int n) {
    (void)x;
    return y[0] / y[n - 1];
}
static double reduce_largest(const double *x, const double *y, int n) {
    (void)x;
    double most = y[0];
    for (int i = 1; i < n; i++) {
        most = fmax(most, y[i]);
    }
    return most;
}
static double reduce_smallest(const double *x, const double *y, int n) {
    (void)x;
    double least = y[0];
    for (int i = 1; i < n; i++) {
        least = fmin(least, y[i]);
    }
    return least;
}
static double reduce_spread(const double *x, const double *y, int n) {
    const double most = reduce_largest(x, y, n), least = reduce_smallest(x, y, n);
    return most == least ? 0 : (most - least) / fmax(fabs(most), fabs(least));
}

#define SEE_REDUCED(name)                                                          \
    static void see_##name(hn_extreme_bench *bench, const hn_extreme_trial *trial, \
                           const hn_extreme_scene *scene, const char *method,      \
                           hn_extreme_seen *out) {                                 \
        double y[HN_EXTREME_SWEEP];                                                \
        if (see_sweep(bench, trial, scene, method, out, y)) {                      \
            out->value = reduce_##name(trial->values, y, trial->n_sweep);          \
        }                                                                          \
    }
SEE_REDUCED(exponent)
SEE_REDUCED(ratio)
SEE_REDUCED(largest)
SEE_REDUCED(smallest)
SEE_REDUCED(spread)

const hn_extreme_measure hn_extreme_measures[] = {
    {"value", "the quantity itself", 1, 0, 0, see_value},
    {"exponent", "the power of the swept number with which it changes, fitted", 1, 1, 0,
     see_exponent},
    {"ratio", "its value at the first number of the sweep over that at the last", 1, 1, 0,
     see_ratio},
    {"largest", "over the sweep", 1, 1, 0, see_largest},
    {"smallest", "over the sweep", 1, 1, 0, see_smallest},
    {"spread", "the largest minus the smallest over the sweep, relative", 1, 1, 0, see_spread},
    {"outcome", "how the run ended, or what the solver answered", 0, -1, 1, see_outcome},
    {"stable-step", "the largest step {h} at which nothing grows [s]", 0, 0, 0,
     hn_extreme_see_stable_step},
    {"lyapunov",
     "rate at which neighbouring motions separate, from pairs that are brought together again and "
     "again [1/s]",
     0, 0, 0, hn_extreme_see_lyapunov},
};
const int hn_extreme_n_measures = sizeof hn_extreme_measures / sizeof *hn_extreme_measures;
