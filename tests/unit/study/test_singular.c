// SPDX-License-Identifier: GPL-3.0-or-later
// A run tells when it comes close to a pose where the closure rows depend on each other, and only
// then.

#include "study/incidents/watch.h"
#include "support/motion.h"
#include "support/near.h"

static int told(const hn_run *run, hn_incident_code code, double times[HN_RUN_MAX_INCIDENTS]) {
    const hn_incident *incidents = NULL;
    int n = 0;
    for (int i = 0, all = hn_run_incidents(run, &incidents); i < all; i++) {
        if (incidents[i].code == code) {
            assert_true(incidents[i].value < incidents[i].limit);
            times[n++] = incidents[i].t;
        }
    }
    return n;
}

static void the_flat_poses_of_a_parallelogram_are_told_twice_a_turn(void **state) {
    (void)state;
    static const char *const methods[] = {"index1@rk4:h=1e-3", "projection@rk4:h=1e-3",
                                          "baumgarte:alpha=50,beta=50@rk4:h=1e-3",
                                          "projection@dopri5:rtol=1e-12"};
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        double t[HN_RUN_MAX_INCIDENTS];
        hn_run *run = hn_motion_start(&m, methods[k]);
        (void)hn_motion_at(run, 1.92); // one turn takes 1.92371 s
        assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, t), 2);

        // flat at 0.70845 s and, by symmetry of a turn, 1.92371 - 0.70845 s; told from 0.015 rad on
        // at 4.95 rad/s
        assert_near(t[0], 0.70845, 0.0045);
        assert_near(t[1], 1.21526, 0.0045);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void short_steps_are_checked_in_full_now_and_then_and_nothing_is_missed(void **state) {
    (void)state;
    double t[HN_RUN_MAX_INCIDENTS];
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=2e-5");

    // far from the flat pose: a full check in a tenth of a length of way, more where it is nearer
    (void)hn_motion_at(run, 0.15);
    const long long checks = hn_run_watching(run)->checks;
    assert_in_range(checks, 2, 100);
    assert_true(50 * checks < hn_run_get_summary(run).steps);

    // close to it: after every step
    (void)hn_motion_at(run, 0.75);
    assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, t), 1);
    assert_near(t[0], 0.70845, 0.0045);
    hn_run_free(run);
    hn_model_close(&m);
}

static void a_pose_in_the_middle_of_a_long_step_is_told_at_its_time(void **state) {
    (void)state;
    static const struct {
        const char *method;
        double longest; // [s] of its steps at least: 0.5 rad and more at 4.95 rad/s
    } runs[] = {{"projection@dopri5:rtol=1e-6", 0.05},
                {"projection@dop853:rtol=1e-8", 0.1},
                {"ggl@radau5:rtol=1e-6", 0.04},
                {"baumgarte@dop853:rtol=1e-6", 0.05}};
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        double t[HN_RUN_MAX_INCIDENTS];
        hn_run *run = hn_motion_start(&m, runs[k].method);
        (void)hn_motion_at(run, 1.92);
        const hn_run_summary s = hn_run_get_summary(run);
        assert_true(1.92 / (double)s.steps > 0.5 * runs[k].longest);
        assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, t), 2);
        // the cubic through both ends of half a radian is off by 1e-4 of it, the motion itself by
        // less
        assert_near(t[0], 0.70845, 5e-4);
        assert_near(t[1], 1.21526, 5e-4);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void with_several_loops_long_steps_tell_the_poses_that_short_ones_tell(void **state) {
    (void)state;
    static const char *const sizes[] = {"N=2", "N=3", "N=10"};
    for (int k = 0; k < 3; k++) {
        double fine[HN_RUN_MAX_INCIDENTS], coarse[HN_RUN_MAX_INCIDENTS];
        hn_model m;
        hn_model_open_closed(&m, "n-four-bar", sizes[k]);
        hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
        (void)hn_motion_at(run, 3);
        const int n = told(run, HN_INCIDENT_NEAR_SINGULAR, fine);
        hn_run_free(run);
        assert_true(n >= 2);
        run = hn_motion_start(&m, "projection@dop853:rtol=1e-8");
        (void)hn_motion_at(run, 3);
        assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, coarse), n);
        for (int i = 0; i < n; i++) {
            assert_near(coarse[i], fine[i], 0.0045); // short steps tell from 0.015 rad on
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void mechanisms_that_keep_clear_are_told_nothing(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@rk4:h=1e-3", "projection@dop853:rtol=1e-5",
                                          "ggl@radau5:rtol=1e-4"};
    static const char *const scenes[] = {"fb0", "fb0-lagrangian", "fb0-tilted", "slider-crank",
                                         "five-bar"};
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        double t[HN_RUN_MAX_INCIDENTS];
        hn_model m;
        hn_model_open_closed(&m, scenes[k], NULL);
        for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
            hn_run *run = hn_motion_start(&m, methods[i]);
            (void)hn_motion_at(run, 3);
            assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, t), 0);
            hn_run_free(run);
        }
        hn_model_close(&m);
    }
}

static void a_second_run_tells_the_same_as_the_first(void **state) {
    (void)state;
    double first[HN_RUN_MAX_INCIDENTS], second[HN_RUN_MAX_INCIDENTS];
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=2");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    (void)hn_motion_at(run, 1);
    int n = told(run, HN_INCIDENT_NEAR_SINGULAR, first);
    assert_int_equal(n, 1);
    assert_int_equal(hn_run_reset(run), HN_OK);
    (void)hn_motion_at(run, 1);
    assert_int_equal(told(run, HN_INCIDENT_NEAR_SINGULAR, second), n);
    assert_near(second[0], first[0], 0);
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_flat_poses_of_a_parallelogram_are_told_twice_a_turn),
        cmocka_unit_test(short_steps_are_checked_in_full_now_and_then_and_nothing_is_missed),
        cmocka_unit_test(a_pose_in_the_middle_of_a_long_step_is_told_at_its_time),
        cmocka_unit_test(with_several_loops_long_steps_tell_the_poses_that_short_ones_tell),
        cmocka_unit_test(mechanisms_that_keep_clear_are_told_nothing),
        cmocka_unit_test(a_second_run_tells_the_same_as_the_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
