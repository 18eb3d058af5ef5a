// SPDX-License-Identifier: GPL-3.0-or-later
// Loads with corners: the run stops at them and starts anew; limits of coordinates are told.
#include "support/near.h"

#include "study/run/run.h"
#include "support/model.h"
#include "support/motion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// a wheel on a torsional spring and a damper, I = 2, k = 50, c = 0.8, pushed by a torque of 1e3 N m
// from t = 0.5 s on
#define WHEEL                                                                                \
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"wheel\",\"mass\":1,\"inertia\":{" \
    "\"zz\":2}}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":"    \
    "\"ground\"},\"child\":{\"body\":\"wheel\"},\"coordinate\":\"th\",\"rate\":\"w\"%s}],"   \
    "\"loads\":[{\"joint_spring\":{\"joint\":\"A\",\"stiffness\":50,\"damping\":0.8}},%s],"  \
    "\"start\":{\"positions\":{\"th\":%g},\"rates\":{\"w\":%g}}}"
static const char STEP_TABLE[] =
    "{\"table\":{\"joint\":\"A\",\"t\":[0,0.5],\"value\":[0,1000],\"steps\":true}}";
static const char STEP_FORMULA[] = "{\"torque\":{\"joint\":\"A\",\"value\":\"1000*step(t-0.5)\"}}";

static void open_wheel(hn_model *m, const char *load, double th, double w) {
    char text[1400];
    snprintf(text, sizeof text, WHEEL, "", load, th, w);
    hn_model_open_text(m, text, NULL);
}

/// th at t from rest at 0 under the torque F from t = 0.5 on.
static double pushed(double t) {
    const double I = 2, k = 50, c = 0.8, F = 1000, s = t - 0.5;
    const double d = c / (2 * I), w = sqrt(k / I - d * d);
    return s <= 0 ? 0 : F / k * (1 - exp(-d * s) * (cos(w * s) + d / w * sin(w * s)));
}

static double error_at(const char *load, const char *integrator, double h, double t) {
    hn_model m;
    char method[80];
    open_wheel(&m, load, 0, 0);
    snprintf(method, sizeof method, "index1@%s:h=%.17g", integrator, h);
    hn_run *run = hn_motion_start(&m, method);
    const double error = fabs(hn_motion_at(run, t).q[0] - pushed(t));
    hn_run_free(run);
    hn_model_close(&m);
    return error;
}

// h = 1/70 s and 1/140 s: 0.5 s is never a grid point of the first, 1.5 s is one of both
static double slope(const char *load, const char *integrator) {
    return log2(error_at(load, integrator, 3.0 / 350, 1.5) /
                error_at(load, integrator, 3.0 / 700, 1.5));
}

static void rk4_keeps_its_order_over_a_corner_of_a_table(void **state) {
    (void)state;
    assert_near(slope(STEP_TABLE, "rk4"), 4, 0.2);
    assert_near(slope(STEP_TABLE, "heun"), 2, 0.2);
}

// the same torque as a formula hides the corner: the error is a whole step's share of the push, far
// above that of rk4
static void a_corner_that_is_hidden_costs_the_order(void **state) {
    (void)state;
    const double hidden = error_at(STEP_FORMULA, "rk4", 3.0 / 350, 1.5),
                 finer = error_at(STEP_FORMULA, "rk4", 3.0 / 3500, 1.5),
                 kept = error_at(STEP_TABLE, "rk4", 3.0 / 350, 1.5);
    const double order = log10(hidden / finer); // over ten times the step
    if (!(order < 2 && hidden > 100 * kept)) {
        fail_msg("order %.2f, %g hidden, %g with the restart", order, hidden, kept);
    }
}

static void steps_end_at_the_corner_and_the_grid_goes_on(void **state) {
    (void)state;
    hn_model m;
    open_wheel(&m, STEP_TABLE, 0, 0);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.2");
    const double expected[] = {0.2, 0.4, 0.5, 0.6000000000000001, 0.8, 1};
    for (int k = 0; k < 6; k++) {
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_true(hn_run_time(run) ==
                    expected[k]); // t0 + n h to the last bit, and the corner itself
    }
    hn_run_free(run);
    run = hn_motion_start(&m, "index1@rk4:h=0.1"); // the corner is a grid point: no step more
    for (int k = 0; k < 10; k++) {
        assert_int_equal(hn_run_step(run), HN_OK);
    }
    assert_near(hn_run_time(run), 1, 1e-15);
    hn_run_free(run);
    hn_model_close(&m);
}

static void an_adaptive_run_lands_on_the_corner_and_rejects_little(void **state) {
    (void)state;
    static const char *const methods[] = {"index1@dopri5:rtol=1e-9", "index1@dop853:rtol=1e-9"};
    for (int k = 0; k < 2; k++) {
        long long rejected[2];
        double error[2];
        for (int hidden = 0; hidden < 2; hidden++) {
            hn_model m;
            open_wheel(&m, hidden ? STEP_FORMULA : STEP_TABLE, 0, 0);
            hn_run *run = hn_motion_start(&m, methods[k]);
            int landed = 0;
            while (hn_run_time(run) < 1.5) {
                assert_int_equal(hn_run_step(run), HN_OK);
                landed |= hn_run_time(run) == 0.5;
            }
            assert_int_equal(landed, !hidden);
            rejected[hidden] = hn_run_get_summary(run).rejected;
            error[hidden] = fabs(hn_motion_at(run, 1.5).q[0] - pushed(1.5));
            hn_run_free(run);
            hn_model_close(&m);
        }
        assert_true(error[0] < 1e-6); // 20 rad times rtol, over some fifty steps
        assert_true(rejected[0] < rejected[1]);
    }
}

// implicit integrators and libraries carry slopes, histories and accelerations that end at a
// corner; the tolerance of a step for a hundred steps of 20 rad
static void implicit_and_library_integrators_begin_anew_at_the_corner(void **state) {
    (void)state;
    static const char *const methods[] = {"index1@radau5:rtol=1e-8", "ggl@radau5:rtol=1e-8",
                                          "index1@ida:rtol=1e-8"};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        hn_model m;
        open_wheel(&m, STEP_TABLE, 0, 0);
        hn_run *run = hn_motion_start(&m, methods[k]);
        int landed = 0;
        while (hn_run_time(run) < 0.6) {
            assert_int_equal(hn_run_step(run), HN_OK);
            landed |= hn_run_time(run) == 0.5;
            // at rest until then: nothing of the push is felt before its time
            assert_true(hn_run_time(run) > 0.5 ||
                        fabs(hn_motion_at(run, hn_run_time(run)).q[0]) == 0);
        }
        const double error = fabs(hn_motion_at(run, 1.5).q[0] - pushed(1.5));
        if (!landed || !(error < 2e-5)) {
            fail_msg("%s: landed %d, %g rad off", methods[k], landed, error);
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static double slope_of(const char *method, double h) {
    double error[2];
    for (int k = 0; k < 2; k++) {
        hn_model m;
        char text[80];
        open_wheel(&m, STEP_TABLE, 0, 0);
        snprintf(text, sizeof text, method, h / (1 << k));
        hn_run *run = hn_motion_start(&m, text);
        error[k] = fabs(hn_motion_at(run, 1.5).q[0] - pushed(1.5));
        hn_run_free(run);
        hn_model_close(&m);
    }
    return log2(error[0] / error[1]);
}

static void structural_and_stiff_integrators_keep_their_order_over_a_corner(void **state) {
    (void)state;
    assert_near(slope_of("index3@genalpha:h=%.17g", 3.0 / 350), 2, 0.2);
    assert_near(slope_of("ggl@genalpha:h=%.17g", 3.0 / 350), 2, 0.2);
    assert_near(slope_of("index1@midpoint:h=%.17g", 3.0 / 350), 2, 0.2);
    assert_near(slope_of("index3@radau3:h=%.17g", 3.0 / 350), 3, 0.2);
    assert_near(slope_of("index1@radau5:h=%.17g", 3.0 / 140), 5, 0.25);
    assert_near(slope_of("ggl@radau5:h=%.17g", 3.0 / 140), 5, 0.25);
}

// a sample ahead of the grid sees the corner on its way as the run will
static void a_sample_beyond_the_corner_is_taken_in_two_steps(void **state) {
    (void)state;
    hn_model m;
    open_wheel(&m, STEP_TABLE, 0, 0);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.01");
    hn_run *late = hn_motion_start(&m, "index1@rk4:h=0.3");
    hn_sample s;
    assert_int_equal(hn_run_advance(late, 0.3), HN_OK);
    assert_int_equal(hn_run_sample(late, 0.51, &s), HN_OK);
    assert_near(s.q[0], hn_motion_at(run, 0.51).q[0], 1e-14); // the same step of 0.01 s from rest
    assert_true(s.q[0] > 0.02);
    hn_run_free(late);
    hn_run_free(run);
    hn_model_close(&m);
}

// ramps 0 -> 3 -> -1: the integral of the torque is the momentum of a free wheel, whatever the grid
static void straight_lines_of_a_table_are_integrated_exactly(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(
        &m,
        "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"wheel\",\"mass\":1,\"inertia\":{"
        "\"zz\":2}}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":"
        "\"ground\"},\"child\":{\"body\":\"wheel\"},\"coordinate\":\"th\"}],\"loads\":[{\"table\":{"
        "\"joint\":\"A\",\"t\":[0.1,0.35,1.23],\"value\":[0,3,-1]}}]}",
        NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.5");
    const double momentum =
        0.25 * 1.5 + 0.88 * 1 - 0.77; // to 2 s, the last value holds from 1.23 s on
    assert_near(hn_motion_at(run, 2).v[0], momentum / 2, 1e-15);
    hn_run_free(run);
    hn_model_close(&m);
}

// a follower of a ramp at constant speed is left behind by nothing: target and rate are met, torque
// is what the spring asks
static void a_follower_without_limit_keeps_to_a_target_that_the_spring_does_not_pull(void **state) {
    (void)state;
    hn_model m;
    open_wheel(&m,
               "{\"follow\":{\"joint\":\"A\",\"stiffness\":5000,\"damping\":200,\"target\":"
               "\"0.3*sin(2*t)\",\"limit\":1e6}}",
               0, 0.6);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=1e-3");
    const hn_sample s = hn_motion_at(run, 3);
    // I x'' + c x' + k x pushes it off by no more than its size over the stiffness
    assert_near(s.q[0], 0.3 * sin(6), (2 * 0.3 * 4 + 0.8 * 0.6 + 50 * 0.3) / 5000);
    const hn_incident *incidents;
    assert_int_equal(hn_run_incidents(run, &incidents), 0); // energy comes in, and that is no jump
    hn_run_free(run);
    hn_model_close(&m);
}

// far off its target a limited follower gives its limit: a = limit / I at rest
static void a_follower_gives_no_more_than_its_limit(void **state) {
    (void)state;
    hn_model m;
    open_wheel(&m, "{\"follow\":{\"joint\":\"A\",\"stiffness\":5000,\"target\":4,\"limit\":7}}", 0,
               0);
    assert_near(m.a[0], 7.0 / 2, 1e-15);
    hn_model_close(&m);
    open_wheel(&m, "{\"follow\":{\"joint\":\"A\",\"stiffness\":5000,\"target\":-4,\"limit\":7}}", 0,
               0);
    assert_near(m.a[0], -7.0 / 2, 1e-15);
    hn_model_close(&m);
}

static void a_limit_is_told_once_each_time_it_is_left(void **state) {
    (void)state;
    hn_model m;
    char text[1400];
    snprintf(text, sizeof text, WHEEL, ",\"limits\":[-0.3,0.25]",
             "{\"torque\":{\"joint\":\"A\",\"value\":\"0.8*w\"}}", 0.0,
             2.0); // undamped: 0.4 rad at 5 rad/s
    hn_model_open_text(&m, text, NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=1e-3");
    assert_int_equal(hn_run_advance(run, 2 * 2 * M_PI / 5), HN_OK);
    const hn_incident *list;
    const int n = hn_run_incidents(run, &list);
    double limits[4];
    int told = 0;
    for (int k = 0; k < n; k++) {
        if (list[k].code == HN_INCIDENT_JOINT_LIMIT && told < 4) {
            assert_string_equal(list[k].quantity, "th");
            // the first step beyond: at most 2 rad/s times 1 ms
            assert_near(list[k].value, list[k].limit, 2e-3);
            assert_true(fabs(list[k].value) > fabs(list[k].limit));
            assert_non_null(strstr(list[k].message, "rad"));
            limits[told++] = list[k].limit;
        }
    }
    assert_int_equal(told, 4); // up and down, twice
    assert_all_near(limits, ((double[]){0.25, -0.3, 0.25, -0.3}), 4, 0);
    assert_string_equal(hn_incident_spelling(HN_INCIDENT_JOINT_LIMIT), "joint-limit");
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rk4_keeps_its_order_over_a_corner_of_a_table),
        cmocka_unit_test(a_corner_that_is_hidden_costs_the_order),
        cmocka_unit_test(steps_end_at_the_corner_and_the_grid_goes_on),
        cmocka_unit_test(an_adaptive_run_lands_on_the_corner_and_rejects_little),
        cmocka_unit_test(implicit_and_library_integrators_begin_anew_at_the_corner),
        cmocka_unit_test(structural_and_stiff_integrators_keep_their_order_over_a_corner),
        cmocka_unit_test(a_sample_beyond_the_corner_is_taken_in_two_steps),
        cmocka_unit_test(straight_lines_of_a_table_are_integrated_exactly),
        cmocka_unit_test(a_follower_without_limit_keeps_to_a_target_that_the_spring_does_not_pull),
        cmocka_unit_test(a_follower_gives_no_more_than_its_limit),
        cmocka_unit_test(a_limit_is_told_once_each_time_it_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
