// SPDX-License-Identifier: GPL-3.0-or-later
// The accuracy watch: its estimate is the error, it says where it ends, and it costs its share.
#include "support/near.h"

#include "study/truth/accuracy.h"
#include "support/model.h"
#include "support/motion.h"

#include <math.h>
#include <string.h>

static hn_accuracy *watch_of(const hn_model *m, double t_end) {
    hn_accuracy *a = NULL;
    assert_int_equal(hn_accuracy_create(m->sys, m->q, m->v, t_end, &a), HN_OK);
    return a;
}

/// A run to t_end with the watch beside it, looked at n times.
static hn_estimate estimate_of(const hn_model *m, hn_accuracy *a, const char *method, double t_end,
                               int n) {
    hn_accuracy_track track = {0};
    hn_run *run = hn_motion_start(m, method);
    for (int k = 1; k <= n; k++) {
        const hn_sample s = hn_motion_at(run, t_end * k / n);
        if (hn_accuracy_reach(a, s.t, hn_run_get_summary(run).cost.ops)) {
            hn_accuracy_see(a, &s, &track);
        }
    }
    const hn_estimate e = hn_accuracy_estimate(a, &track, t_end);
    hn_run_free(run);
    return e;
}

/// The largest difference of q from a run by another formulation at a tight tolerance.
static double true_error(const hn_model *m, const char *method, double t_end, int n) {
    hn_run *run = hn_motion_start(m, method);
    hn_run *truth = hn_motion_start(m, "nullspace@dop853:rtol=1e-12");
    double worst = 0;
    for (int k = 1; k <= n; k++) {
        const hn_sample s = hn_motion_at(run, t_end * k / n);
        const hn_sample r = hn_motion_at(truth, t_end * k / n);
        for (int i = 0; i < m->info.n_user; i++) {
            worst = fmax(worst, fabs(s.q[i] - r.q[i]));
        }
    }
    hn_run_free(run);
    hn_run_free(truth);
    return worst;
}

// angles only: nothing is divided by a length
static void the_estimate_is_the_error(void **state) {
    (void)state;
    static const char *const methods[] = {"index1@rk4:h=1e-2", "projection@rk4:h=2e-2",
                                          "ggl@radau5:rtol=1e-4", "nullspace@dopri5:rtol=1e-5"};
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    for (int i = 0; i < 4; i++) {
        hn_accuracy *a = watch_of(&m, 3);
        const hn_estimate e = estimate_of(&m, a, methods[i], 3, 50);
        const double error = true_error(&m, methods[i], 3, 50);
        assert_true(e.known && e.t == 3 && e.reason[0] == '\0');
        // the pilot's own error is a hundredth of these, or less
        assert_true(error > 1e-6);
        assert_near(e.q, error, 0.05 * error);
        hn_accuracy_free(a);
    }
    hn_model_close(&m);
}

static void the_motion_is_the_same_to_the_last_bit(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "slider-crank", NULL);
    hn_run *alone = hn_motion_start(&m, "projection@rk4:h=1e-2");
    const hn_sample before = hn_motion_at(alone, 2);
    hn_accuracy *a = watch_of(&m, 2);
    hn_run *watched = hn_motion_start(&m, "projection@rk4:h=1e-2");
    for (int k = 1; k <= 20; k++) {
        const hn_sample s = hn_motion_at(watched, 0.1 * k);
        (void)hn_accuracy_reach(a, s.t, 0);
    }
    const hn_sample after = hn_motion_at(watched, 2);
    assert_memory_equal(before.q, after.q, (size_t)m.info.n_user * sizeof(double));
    assert_memory_equal(before.v, after.v, (size_t)m.info.n_user * sizeof(double));
    hn_accuracy_free(a);
    hn_run_free(alone);
    hn_run_free(watched);
    hn_model_close(&m);
}

// 0.1 rad between two tolerances at 7 s: no run can be judged by the pilot there
static void the_estimate_of_a_chaotic_motion_ends_and_says_so(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "double-pendulum", NULL);
    hn_accuracy *a = watch_of(&m, 10);
    const hn_estimate e = estimate_of(&m, a, "index1@rk4:h=1e-3", 10, 100);
    assert_true(e.known && e.t > 3 && e.t < 9);
    assert_true(e.own < HN_ACCURACY_LOST);
    assert_non_null(strstr(e.reason, "neighbouring motions part too fast"));
    hn_accuracy_free(a);
    hn_model_close(&m);
}

// the platform's drives hold the pilot to small steps: it ends early, and says where
static void the_watch_takes_no_more_than_its_share(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "stewart-6-3", NULL);
    hn_accuracy *a = watch_of(&m, 2);
    const hn_estimate e = estimate_of(&m, a, "projection@rk4:h=1e-3", 2, 20);
    const double ops = hn_motion_summary(&m, "projection@rk4:h=1e-3", 2).cost.ops;
    // one step more of the pilot: 12 stages
    assert_true(hn_accuracy_ops(a) < HN_ACCURACY_FREE + HN_ACCURACY_SHARE * ops + 1e6);
    assert_true(e.t < 2);
    assert_non_null(strstr(e.reason, "a tenth of the run's own operations"));
    hn_accuracy_free(a);
    hn_model_close(&m);
}

// the pilot's own method at its own tolerance, coarser and finer: the estimate is the error, or
// what the pilot may be off itself, and never below the error
static void a_run_by_the_pilots_method_is_judged_too(void **state) {
    (void)state;
    static const char *const methods[] = {
        "projection@dop853:rtol=1e-5", "nullspace@dop853:rtol=1e-7", "projection@dop853:rtol=1e-8",
        "nullspace@dop853:rtol=1e-10"};
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_accuracy *a = watch_of(&m, 3);
    for (int i = 0; i < 4; i++) {
        const hn_estimate e = estimate_of(&m, a, methods[i], 3, 50);
        const double error = true_error(&m, methods[i], 3, 50);
        assert_true(e.known && e.t == 3);
        assert_true(e.q >= e.own && e.q > 0.95 * error); // 0.95: as in the_estimate_is_the_error
        assert_true(e.q < 1.05 * error + 2 * e.own);
        hn_accuracy_reset(a);
    }
    hn_accuracy_free(a);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_is_the_error),
        cmocka_unit_test(the_motion_is_the_same_to_the_last_bit),
        cmocka_unit_test(the_estimate_of_a_chaotic_motion_ends_and_says_so),
        cmocka_unit_test(the_watch_takes_no_more_than_its_share),
        cmocka_unit_test(a_run_by_the_pilots_method_is_judged_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
