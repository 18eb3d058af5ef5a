// SPDX-License-Identifier: GPL-3.0-or-later
// The characteristic length, by which gaps are judged, is the mechanism's own, however the scene
// was written.

#include "dynamics/compile/compile.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>

static double length_of(const char *name) {
    hn_model m;
    hn_model_open_closed(&m, name, NULL);
    double length = hn_system_length(m.sys);
    hn_model_close(&m);
    return length;
}

static void formulas_and_bodies_of_one_mechanism_have_one_length(void **state) {
    (void)state;
    assert_near(length_of("fb0"), 2, 0); // the coupler
    assert_near(length_of("fb0-lagrangian"), 2, 1e-15 * 4);
}

static void a_small_mechanism_of_formulas_is_small(void **state) {
    (void)state;
    double bodies = length_of("andrews"), formulas = length_of("andrews-lagrangian");
    assert_true(bodies > 0.02 && bodies < 0.1); // links of 7 to 48 mm
    assert_true(formulas > 0.02 && formulas < 0.1);
}

static void formulas_without_angles_have_length_one(void **state) {
    (void)state;
    assert_near(length_of("a01-simple-pendulum"), 1, 0);
    assert_near(length_of("caraxis"), 1, 0);
}

/// A loop of links of 0.3, 0.5 and 0.5 m, the axes turned by `turn`; its start is near enough to a
/// closed one.
static double length_turned_by(double turn, int symbolic) {
    char text[1024];
    hn_model m;
    (void)snprintf(
        text, sizeof text,
        "{\"holonom\": 1, \"name\": \"turned\", \"parameters\": {\"a\": 0.3, \"b\": 0.5}, "
        "\"lagrangian\": {\"coordinates\": [{\"name\": \"p\"}, {\"name\": \"q\"}, {\"name\": "
        "\"s\"}],"
        "\"kinetic\": \"(d_p^2 + d_q^2 + d_s^2)/2\", \"constraints\": ["
        "\"a*cos(p + %.17g) + b*cos(q + %.17g) - b*cos(s + %.17g)\","
        "\"a*sin(p + %.17g) + b*sin(q + %.17g) - b*sin(s + %.17g)\"]},"
        "\"start\": {\"positions\": {\"p\": 0.4, \"q\": {\"guess\": 0.1}, \"s\": {\"guess\": "
        "0.7}}}}",
        turn, turn, turn, turn, turn, turn);
    hn_model_open_text(&m, text, NULL);
    double length = hn_system_length(m.sys);
    if (symbolic) {
        const hn_system_opts opts = {.symbolic_params = 1};
        hn_system *sys;
        assert_int_equal(hn_system_compile(m.scene, &opts, &sys, NULL), HN_OK);
        length = hn_system_length(sys);
        hn_system_free(sys);
    }
    hn_model_close(&m);
    return length;
}

static void turning_the_axes_leaves_the_length(void **state) {
    (void)state;
    for (int k = 0; k < 7; k++) {
        assert_near(length_turned_by(k, 0), 0.5, 1e-15);
    }
}

static void parameters_that_stay_symbols_leave_the_length(void **state) {
    (void)state;
    assert_near(length_turned_by(0.3, 1), 0.5, 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formulas_and_bodies_of_one_mechanism_have_one_length),
        cmocka_unit_test(a_small_mechanism_of_formulas_is_small),
        cmocka_unit_test(formulas_without_angles_have_length_one),
        cmocka_unit_test(turning_the_axes_leaves_the_length),
        cmocka_unit_test(parameters_that_stay_symbols_leave_the_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
