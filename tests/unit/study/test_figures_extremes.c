// SPDX-License-Identifier: GPL-3.0-or-later
// Facts that hold whatever the speed of a mechanism, and how explicit Euler gains energy: closed
// forms.

#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>

/// Relative energy error of the reference four-bar without gravity after ten radians of its crank's
/// starting speed.
static double relative_energy_error(const char *formulation, const char *integrator, double speed) {
    hn_model m;
    char method[96];
    (void)snprintf(method, sizeof method, "%s@%s:h=%.17g", formulation, integrator, 0.01 / speed);
    hn_model_open_closed(&m, "fb0", "g=0");
    for (int i = 0; i < m.info.nv; i++) {
        m.v[i] *= speed / 2; // the crank starts with 2 rad/s
    }
    hn_run *run = hn_motion_start(&m, method);
    const double start = hn_motion_at(run, 0).energy;
    const double error = hn_motion_at(run, 10 / speed).energy - start;
    hn_run_free(run);
    hn_model_close(&m);
    return error / start;
}

static void
without_gravity_ten_thousand_times_the_speed_gives_the_same_relative_errors(void **state) {
    (void)state;
    static const char *const pairs[][2] = {{"index1", "rk4"},    {"projection", "rk4"},
                                           {"nullspace", "rk4"}, {"reduced", "rk4"},
                                           {"index3", "rattle"}, {"ggl", "genalpha"}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const double slow = relative_energy_error(pairs[i][0], pairs[i][1], 1);
        const double fast = relative_energy_error(pairs[i][0], pairs[i][1], 1e4);
        assert_true(fabs(slow) > 1e-9); // an error there is to compare
        // what differs is rounding: 1e-14 of the energy in some thousand operations
        assert_near(fast, slow, 1e-12 + 1e-6 * fabs(slow));
    }
}

/// Energy after t over that at the start, of a pendulum that swings by a ten-thousandth of a
/// radian.
static double euler_growth(double h, double t) {
    hn_model m;
    char method[48];
    (void)snprintf(method, sizeof method, "index1@euler:h=%g", h);
    hn_model_open_text(&m,
                       "{\"holonom\": 1, \"name\": \"bob\", \"gravity\": [0, -9.81, 0],"
                       "\"bodies\": [{\"name\": \"bob\", \"mass\": 1, \"com\": [0, -1, 0]}],"
                       "\"joints\": [{\"name\": \"O\", \"type\": \"revolute\", \"parent\": "
                       "{\"body\": \"ground\"}, \"child\": {\"body\": \"bob\"}, \"coordinate\": "
                       "\"th\", \"rate\": \"w\"}],"
                       "\"start\": {\"positions\": {\"th\": 1e-4}, \"rates\": {\"w\": 0}}}",
                       NULL);
    assert_int_equal(m.status, HN_OK);
    hn_run *run = hn_motion_start(&m, method);
    hn_sample s = hn_motion_at(run, 0);
    const double start = 0.5 * 9.81 * s.q[0] * s.q[0];
    s = hn_motion_at(run, t);
    const double end = 0.5 * (s.v[0] * s.v[0] + 9.81 * s.q[0] * s.q[0]);
    hn_run_free(run);
    hn_model_close(&m);
    return end / start;
}

static void
explicit_euler_gains_one_plus_h_squared_w_squared_of_the_energy_each_step(void **state) {
    (void)state;
    static const double steps[] = {0.02, 0.01, 0.005};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const double h = steps[i], t = 10;
        // a swing of 1e-4 rad (1e-2 rad at the end) departs from the harmonic by the square of that
        assert_rel(log(euler_growth(h, t)), t / h * log1p(h * h * 9.81), 1e-4);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            without_gravity_ten_thousand_times_the_speed_gives_the_same_relative_errors),
        cmocka_unit_test(explicit_euler_gains_one_plus_h_squared_w_squared_of_the_energy_each_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
