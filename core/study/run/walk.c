// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/walk.h"

#include "base/clock.h"
#include "study/run/pace.h"

#include <math.h>

#define SAME_TIME 1e-14 // relative
#define SAME_STEP 1e-9  // of a step

hn_walk_end hn_walk_ask(const hn_walk_limits *limits, double started) {
    if (limits->stop && limits->stop(limits->user)) {
        return HN_WALK_STOPPED;
    }
    return limits->seconds > 0 && hn_clock_thread() - started > limits->seconds ? HN_WALK_OVER
                                                                                : HN_WALK_DONE;
}

static hn_walk_end step_to(hn_run *run, double t, double started, hn_pace *pace,
                           const hn_walk_limits *limits) {
    hn_walk_end end = HN_WALK_DONE;
    while (end == HN_WALK_DONE && hn_run_time(run) < t * (1 - SAME_TIME)) {
        if (hn_run_step_towards(run, t) != HN_OK) {
            return HN_WALK_FAILED;
        }
        if (hn_pace_is_due(pace)) {
            end = hn_walk_ask(limits, started);
        }
    }
    return end;
}

hn_walk_end hn_walk(hn_run *run, double T, int n, const hn_walk_limits *limits, hn_walk_see see,
                    void *user) {
    const hn_method_spec *spec = hn_run_spec(run);
    const double h = hn_method_is_adaptive(spec) ? 0 : hn_method_option(spec, "h", 0);
    hn_pace pace = hn_pace_begin();
    const double started = pace.last;
    for (int k = see ? 1 : n; k <= n; k++) {
        const double t = k == n ? T : T * k / n;
        const double target = h > 0 ? floor(t / h + SAME_STEP) * h : t;
        const hn_walk_end end = step_to(run, target, started, &pace, limits);
        hn_sample sample;
        if (end != HN_WALK_DONE) {
            return end;
        }
        if (see && (hn_run_sample(run, t, &sample) != HN_OK || !see(user, k, &sample))) {
            return HN_WALK_FAILED;
        }
    }
    return HN_WALK_DONE;
}
