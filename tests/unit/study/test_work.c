// SPDX-License-Identifier: GPL-3.0-or-later
// The work of drives, dampers and loads against closed forms: a change of energy is what is left.
#include "support/near.h"

#include "support/model.h"
#include "support/motion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A wheel, I = 2, at 3 rad/s, with a damper c = 0.8.
static const char WHEEL[] =
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"wheel\",\"mass\":1,\"inertia\":{"
    "\"zz\":2}}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"}"
    ",\"child\":{\"body\":\"wheel\"},\"coordinate\":\"th\",\"rate\":\"w\"}],\"loads\":[{"
    "\"joint_spring\":{\"joint\":\"A\",\"damping\":0.8}}],\"start\":{\"positions\":{\"th\":0},"
    "\"rates\":{\"w\":3}}}";

/// A pendulum of 2 kg on 0.7 m, released level, with a damper c = 0.3 at its pivot.
static const char PENDULUM[] =
    "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"bob\",\"mass\":2"
    ",\"com\":[0,-0.7,0]}],\"joints\":[{\"name\":\"O\",\"type\":\"revolute\",\"parent\":{\"body\":"
    "\"ground\"},\"child\":{\"body\":\"bob\"},\"coordinate\":\"th\",\"rate\":\"w\"}],\"loads\":[{"
    "\"joint_spring\":{\"joint\":\"O\",\"damping\":0.3}}],\"start\":{\"positions\":{\"th\":1.5},"
    "\"rates\":{\"w\":0}}}";

/// A lift of 3 kg under a load of 40 N along its guide; %s: the load.
#define LIFT                                                                                \
    "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"lift\"," \
    "\"mass\":3}],\"joints\":[{\"name\":\"G\",\"type\":\"prismatic\",\"axis\":[0,1,0],"     \
    "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"lift\"},\"coordinate\":\"y\","  \
    "\"rate\":\"vy\"}],\"loads\":[%s],\"start\":{\"positions\":{\"y\":0},\"rates\":{\"vy\":0}}}"

/// A body on a ball joint, 0.2 kg m^2 about every axis, turned by 0.5 N m about the world's z.
static const char BALL[] =
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"ball\",\"mass\":1,\"inertia\":{"
    "\"xx\":0.2,\"yy\":0.2,\"zz\":0.2}}],\"joints\":[{\"name\":\"S\",\"type\":\"spherical\","
    "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"ball\"}}],\"loads\":[{\"moment\":{"
    "\"body\":\"ball\",\"value\":[0,0,0.5]}}],\"start\":{}}";

static hn_sample sample_at(hn_run *run, double t) {
    const hn_sample s = hn_motion_at(run, t);
    // energy, work and what is left belong together
    assert_near(s.energy - s.work - s.energy_change, hn_run_watching(run)->energy.start, 1e-12);
    return s;
}

static double brake_work(double t) {
    const double I = 2, c = 0.8, w = 3;
    return -I * w * w / 2 * (1 - exp(-2 * c / I * t));
}

static void a_damper_takes_what_the_closed_form_says(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, WHEEL, NULL);
    hn_run *run = hn_motion_start(&m, "index1@dopri5:rtol=1e-10");
    const double times[] = {0.001, 0.5, 1.234, 3};
    for (int k = 0; k < 4; k++) {
        const hn_sample s = sample_at(run, times[k]);
        assert_near(s.work, brake_work(times[k]), 2e-9); // of 9 J, over 3 s at 1e-10
        assert_near(s.energy_change, 0, 2e-9);
    }
    assert_true(hn_run_get_summary(run).worst_energy_change < 2e-9);
    hn_run_free(run);
    hn_model_close(&m);
}

/// Returns the rest of the damped pendulum's energy after 2 s.
static double left(const hn_model *m, const char *integrator, double h) {
    char method[64];
    snprintf(method, sizeof method, "index1@%s:h=%g", integrator, h);
    hn_run *run = hn_motion_start(m, method);
    const double change = sample_at(run, 2).energy_change;
    hn_run_free(run);
    return fabs(change);
}

// the quadrature must not be what is measured: the change has the order of the method
static void what_is_left_of_the_energy_has_the_order_of_the_method(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, PENDULUM, NULL);
    assert_near(log2(left(&m, "midpoint", 0.02) / left(&m, "midpoint", 0.01)), 2, 0.05);
    assert_near(log2(left(&m, "rk4", 0.005) / left(&m, "rk4", 0.0025)), 4, 0.2);
    hn_run *run = hn_motion_start(&m, "index1@dop853:rtol=1e-11");
    assert_near(sample_at(run, 2).energy_change, 0, 1e-9); // of 13 J
    hn_run_free(run);
    hn_model_close(&m);
}

static void open_lift(hn_model *m, const char *load) {
    char text[1200];
    snprintf(text, sizeof text, LIFT, load);
    hn_model_open_text(m, text, NULL);
}

// x = (F / m - g) t^2 / 2 is a parabola, which every order beyond 2 has exactly
static void a_load_that_lifts_does_force_times_height(void **state) {
    (void)state;
    hn_model m;
    open_lift(&m, "{\"force\":{\"joint\":\"G\",\"value\":40}}");
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.1");
    for (int k = 1; k <= 15; k++) {
        const double t = 0.07 * k;
        const hn_sample s = sample_at(run, t);
        assert_near(s.work, 40 * s.q[0], 1e-12);
        assert_near(s.q[0], (40.0 / 3 - 9.81) * t * t / 2, 1e-13);
        assert_near(s.energy_change, 0, 1e-12);
    }
    hn_run_free(run);
    hn_model_close(&m);
}

// the load ends at 0.55 s, inside a step and inside the time between two samples
static void work_ends_where_the_table_of_a_load_ends(void **state) {
    (void)state;
    hn_model m;
    open_lift(&m, "{\"table\":{\"joint\":\"G\",\"t\":[0,0.55],\"value\":[40,0],\"steps\":true}}");
    static const char *const methods[] = {"index1@rk4:h=0.1", "index1@dopri5:rtol=1e-9"};
    for (int i = 0; i < 2; i++) {
        hn_run *run = hn_motion_start(&m, methods[i]);
        const double height = (40.0 / 3 - 9.81) * 0.55 * 0.55 / 2;
        const double times[] = {0.3, 0.53, 0.55, 0.57, 0.65, 1};
        for (int k = 0; k < 6; k++) {
            const hn_sample s = sample_at(run, times[k]);
            assert_near(s.work, 40 * (times[k] < 0.55 ? s.q[0] : height), 1e-11);
            assert_near(s.energy_change, 0, 1e-11);
        }
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// N phi with phi = N t^2 / 2 I, four and more turns: the angle is in a quaternion
static void a_moment_on_a_ball_does_moment_times_angle(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, BALL, NULL);
    hn_run *run = hn_motion_start(&m, "index1@dop853:rtol=1e-10");
    for (int k = 1; k <= 5; k++) {
        const double t = k, angle = 0.5 * t * t / (2 * 0.2);
        assert_near(sample_at(run, t).work, 0.5 * angle, 1e-6); // of 15 J
        assert_near(sample_at(run, t).energy_change, 0, 1e-6);
    }
    hn_run_free(run);
    hn_model_close(&m);
}

static void nothing_is_computed_where_nothing_does_work(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=0.01");
    const hn_sample s = sample_at(run, 1);
    assert_true(s.work == 0);
    assert_false(hn_run_watching(run)->work.on);
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_damper_takes_what_the_closed_form_says),
        cmocka_unit_test(what_is_left_of_the_energy_has_the_order_of_the_method),
        cmocka_unit_test(a_load_that_lifts_does_force_times_height),
        cmocka_unit_test(work_ends_where_the_table_of_a_load_ends),
        cmocka_unit_test(a_moment_on_a_ball_does_moment_times_angle),
        cmocka_unit_test(nothing_is_computed_where_nothing_does_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
