#include "study/walk.h"

#include <math.h>
#include <time.h>

enum { STEPS_BETWEEN_CLOCKS = 64 };
#define SAME_TIME 1e-14 // relative
#define SAME_STEP 1e-9  // of a step

double hn_thread_seconds(void) {
    struct timespec ts;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

static hn_walk_end step_to(hn_run *run, double t, double started, const hn_walk_limits *limits) {
    for (int n = 1; hn_run_time(run) < t * (1 - SAME_TIME); n++) {
        if (hn_run_step_towards(run, t) != HN_OK) {
            return HN_WALK_FAILED;
        }
        if (n % STEPS_BETWEEN_CLOCKS == 0) {
            n = 0;
            if (limits->stop && limits->stop(limits->user)) {
                return HN_WALK_STOPPED;
            }
            if (limits->seconds > 0 && hn_thread_seconds() - started > limits->seconds) {
                return HN_WALK_OVER;
            }
        }
    }
    return HN_WALK_DONE;
}

hn_walk_end hn_walk(hn_run *run, double T, int n, const hn_walk_limits *limits, hn_walk_see see,
                    void *user) {
    const hn_method_spec *spec = hn_run_spec(run);
    const double h = hn_method_is_adaptive(spec) ? 0 : hn_method_setting(spec, "h", 0);
    const double started = hn_thread_seconds();
    for (int k = see ? 1 : n; k <= n; k++) {
        const double t = k == n ? T : T * k / n;
        const double target = h > 0 ? floor(t / h + SAME_STEP) * h : t;
        const hn_walk_end end = step_to(run, target, started, limits);
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
