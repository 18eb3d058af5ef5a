// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_stable.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_measure.h"
#include "session/extreme/extreme_verdict.h"
#include "session/extreme/extreme_walk.h"

#include "linalg/dense.h"
#include "study/spectrum/region.h"
#include "study/spectrum/spectrum.h"
#include "study/truth/chaos.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// growth from the second to the last quarter of the steps above which a motion counts as growing; a
// neutral motion stays below
#define GROWN 1.01
// a motion below this share of the first quarter's rates is rounding noise and has decayed
#define DECAYED 1e-6
#define BRACKET 1.6       // the search goes this factor below and above the prediction
#define SMALL_STEP 1e-9   // [s], for a run that is never stepped
#define SAME_LIMIT 2.5e-4 // relative width at which the search ends

static bool fail(hn_extreme_seen *out, hn_status status, const char *reason) {
    out->value = (double)NAN;
    snprintf(out->reason, sizeof out->reason, "%s%s%.150s", hn_extreme_outcome(status),
             reason[0] ? ": " : "", reason);
    return false;
}

/// Returns the same trial with the step size as its swept name.
static hn_extreme_trial with_step(const hn_extreme_trial *trial) {
    hn_extreme_trial t = *trial;
    t.sweep = "h";
    return t;
}

// the largest stable step ----

/// Finds the largest rate in each quarter of the steps. Returns 0 when the run ended early or was
/// stopped.
static bool walk_quarters(hn_extreme_bench *bench, hn_run *run, int n, long long steps,
                          double most[4]) {
    for (long long k = 1; k <= steps; k++) {
        hn_sample s;
        if (hn_run_step(run) != HN_OK || (k % 256 == 0 && hn_extreme_is_stopped(bench))) {
            return false;
        }
        const int quarter = (int)(4 * (k - 1) / steps);
        if (hn_run_sample(run, hn_run_time(run), &s) != HN_OK) {
            return false;
        }
        most[quarter] = fmax(most[quarter], hn_norm_max(n, s.v));
    }
    return true;
}

/// Returns 1 if the motion does not grow at step h, 0 if it does, -1 if unknown (reason in out).
static int is_stable(hn_extreme_bench *bench, hn_extreme_point *point, double h,
                     hn_extreme_seen *out) {
    hn_extreme_check look;
    double most[4] = {0, 0, 0, 0};

    // start a run at this step size; it stays at its start (time 0)
    point->value = h;
    hn_extreme_check_begin(bench, point, 0, &look);
    if (!look.run) {
        fail(out, look.status, look.reason);
        hn_extreme_check_end(&look);
        return -1;
    }

    // the largest velocity in each quarter of the steps
    const int n = hn_system_get_info(hn_model_system(look.model)).n_user;
    const int whole = walk_quarters(bench, look.run, n, (long long)point->trial->steps, most);

    // an adaptive method that shortened the step did not hold it: counts as growth
    const double steps = floor(point->trial->steps);
    const int held = hn_run_time(look.run) > steps * h * (1 - 1e-6);

    hn_extreme_check_end(&look);
    if (hn_extreme_is_stopped(bench)) {
        fail(out, HN_ERR_STOPPED, "stopped");
        return -1;
    }

    // stable: hardly any growth since the second quarter, or decay since the first
    return whole && held && (most[3] <= GROWN * most[1] || most[3] <= DECAYED * most[0]);
}

/// Narrows the interval from a stable `low` to an unstable `high` down to the limit. Returns 0 when
/// there is none (reason in out).
static bool search(hn_extreme_bench *bench, hn_extreme_point *point, double low, double high,
                   hn_extreme_seen *out) {
    // the interval must enclose the limit
    const int at_low = is_stable(bench, point, low, out);
    const int at_high = at_low == 1 ? is_stable(bench, point, high, out) : 0;
    if (at_low < 0 || at_high < 0) {
        return false;
    }
    if (at_low == 0 || at_high == 1) {
        snprintf(out->reason, sizeof out->reason, "%s at h = %g s already",
                 at_low == 0 ? "grows" : "does not grow", at_low == 0 ? low : high);
        return false;
    }

    // bisect in ratios
    while (high > low * (1 + SAME_LIMIT)) {
        const double middle = sqrt(low * high);
        const int stable = is_stable(bench, point, middle, out);
        if (stable < 0) {
            return false;
        }
        *(stable ? &low : &high) = middle;
    }
    out->value = sqrt(low * high);
    return true;
}

/// Returns the largest stable step that the spectrum on the loops predicts at the start
/// of a trial's run [s]; NaN with a reason in out.
static double predict(hn_extreme_bench *bench, const hn_extreme_point *point,
                      hn_extreme_seen *out) {
    hn_extreme_check look;
    hn_spectrum *spectrum = NULL;
    const hn_eigenvalue *s = NULL;
    int n = 0;
    double limit = (double)NAN;

    // make the run, and leave it at its start
    hn_extreme_check_begin(bench, point, 0, &look);

    // the eigenvalues at its start
    hn_status status = look.status;
    HN_THEN(status, hn_spectrum_create(hn_model_system(look.model), look.arena, &spectrum));
    HN_THEN(status, hn_spectrum_calc(spectrum, 0, look.q, look.v, &s, &n));

    // the step limit of the method for these eigenvalues
    if (status == HN_OK) {
        const hn_stepper *stepper = hn_run_spec(look.run)->stepper;
        const char *why_not = hn_stability_why_not(stepper);
        limit = hn_stability_limit(stepper, s, n);
        snprintf(out->reason, sizeof out->reason, "%.199s", why_not ? why_not : "");
    } else {
        fail(out, status, look.reason);
    }

    hn_spectrum_free(spectrum);
    hn_extreme_check_end(&look);

    // a limit of 0 or infinity cannot be compared with
    if (!isnan(limit) && !(limit > 0 && limit < HUGE_VAL)) {
        snprintf(out->reason, sizeof out->reason, "the spectrum gives the limit %g s", limit);
        return (double)NAN;
    }
    return limit;
}

void hn_extreme_see_stable_step(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                                const hn_extreme_scene *scene, const char *method,
                                hn_extreme_seen *out) {
    hn_extreme_trial t = with_step(trial);
    hn_extreme_point point = {&t, scene, method, 0};
    double low = t.limit[0], high = t.limit[1];
    double unit = t.scale;
    out->value = (double)NAN;
    if (t.expect.from_spectrum) {
        point.value = SMALL_STEP;
        unit = predict(bench, &point, out);
        low = unit / BRACKET;
        high = unit * BRACKET;
        if (isnan(unit)) {
            return;
        }
    }
    if (search(bench, &point, low, high, out)) {
        out->value /= unit;
    }
}

// chaos ----

static int ask_bench(void *user) {
    return hn_extreme_is_stopped(user);
}

void hn_extreme_see_lyapunov(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                             const hn_extreme_scene *scene, const char *method,
                             hn_extreme_seen *out) {
    hn_extreme_trial still = *trial;
    still.time = (hn_extreme_number){0}; // the run stays at its start
    const hn_extreme_point point = {&still, scene, method, 0};
    const hn_walk_limits limits = {.stop = ask_bench, .user = bench};
    hn_extreme_check look;
    hn_chaos chaos;
    hn_diag diag = {0};
    out->value = (double)NAN;
    hn_extreme_check_begin(bench, &point, 0, &look);
    hn_status status = look.status;
    if (status != HN_OK) {
        fail(out, status, look.reason);
    } else {
        status = hn_chaos_estimate(hn_model_system(look.model), look.q, look.v, trial->time.value,
                                   &limits, &chaos, &diag);
        if (status == HN_OK) {
            out->value = chaos.exponent / trial->scale;
        } else {
            fail(out, status, diag.message);
        }
    }
    hn_extreme_check_end(&look);
}
