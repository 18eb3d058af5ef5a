// SPDX-License-Identifier: GPL-3.0-or-later
// Assembly modes: those of all loops are told, and the one that a scene asks for is reached, or
// missed with its reason.
#include "support/near.h"

#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 4000 };

/// A crank at 1 rad and two dyads in a row: crank 1, coupler 2, rocker 1.8 on a ground of 2.2 m;
/// from the coupler's middle a rod of 1.2 m to a lever of 1.3 m that turns at (1.2, 1.9).
static const char *write_scene(char out[TEXT], const char *mode, const char *more_pins) {
    snprintf(
        out, TEXT,
        "{\"holonom\":1,\"name\":\"two dyads\",\"gravity\":[0,-9.81,0],\"bodies\":["
        "{\"name\":\"crank\",\"mass\":1,\"inertia\":{\"zz\":1}},"
        "{\"name\":\"coupler\",\"mass\":1,\"inertia\":{\"zz\":1}},"
        "{\"name\":\"rocker\",\"mass\":1,\"inertia\":{\"zz\":1}},"
        "{\"name\":\"rod\",\"mass\":1,\"inertia\":{\"zz\":1}},"
        "{\"name\":\"lever\",\"mass\":1,\"inertia\":{\"zz\":1}}],\"joints\":["
        "{\"name\":\"O1\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},"
        "\"child\":{\"body\":\"crank\"},\"coordinate\":\"th1\"},"
        "{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":\"crank\",\"at\":[1,0,0]},"
        "\"child\":{\"body\":\"coupler\"},\"coordinate\":\"a2\"},"
        "{\"name\":\"O3\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\",\"at\":[2.2,0,0]},"
        "\"child\":{\"body\":\"rocker\"},\"coordinate\":\"th3\"},"
        "{\"name\":\"B\",\"type\":\"revolute\",\"parent\":{\"body\":\"coupler\",\"at\":[2,0,0]},"
        "\"child\":{\"body\":\"rocker\",\"at\":[1.8,0,0]},\"cut\":true},"
        "{\"name\":\"C\",\"type\":\"revolute\",\"parent\":{\"body\":\"coupler\",\"at\":[1,0,0]},"
        "\"child\":{\"body\":\"rod\"},\"coordinate\":\"c4\"},"
        "{\"name\":\"O5\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\",\"at\":[1.2,1.9,0]}"
        ","
        "\"child\":{\"body\":\"lever\"},\"coordinate\":\"th5\"},"
        "{\"name\":\"D\",\"type\":\"revolute\",\"parent\":{\"body\":\"rod\",\"at\":[1.2,0,0]},"
        "\"child\":{\"body\":\"lever\",\"at\":[1.3,0,0]},\"cut\":true}],"
        "\"start\":{%s%s%s\"positions\":{\"th1\":1%s}}}",
        mode ? "\"mode\":\"" : "", mode ? mode : "", mode ? "\"," : "", more_pins);
    return out;
}

/// The coupler's angle in both modes, by the triangle of coupler and rocker over the diagonal.
static double coupler_angle(int sign) {
    const double ex = 2.2 - cos(1.0), ey = -sin(1.0), L = hypot(ex, ey);
    return atan2(ey, ex) + sign * acos((4 + L * L - 1.8 * 1.8) / (4 * L));
}

/// The rod turns left or right from the diagonal between its joint on the coupler and the lever's
/// pivot.
static double rod_side(const hn_model *m) {
    const double th2 = m->user_q[hn_model_user(m, "th1")] + m->user_q[hn_model_user(m, "a2")];
    const double th4 = th2 + m->user_q[hn_model_user(m, "c4")];
    const double x = 1.2 - cos(1.0) - cos(th2), y = 1.9 - sin(1.0) - sin(th2);
    return x * sin(th4) - y * cos(th4);
}

static void every_mode_of_two_dyads_is_reached_when_asked_for(void **state) {
    static const char *const modes[] = {"++", "+-", "-+", "--"};
    double side[2] = {0, 0};
    (void)state;
    for (int k = 0; k < 4; k++) {
        char text[TEXT];
        hn_model m;
        hn_model_open_text(&m, write_scene(text, modes[k], ""), NULL);
        assert_int_equal(m.status, HN_OK);
        assert_string_equal(m.assembly.modes, modes[k]);
        assert_true(m.assembly.gap < 1e-12);
        const double th2 = 1 + m.user_q[hn_model_user(&m, "a2")];
        const double expected = coupler_angle(modes[k][0] == '+' ? 1 : -1);
        assert_near(remainder(th2 - expected, 2 * M_PI), 0, 1e-12);
        assert_near(m.user_q[hn_model_user(&m, "th1")], 1, 0);
        // the sign of the second loop is the side on which its dyad stands
        const double now = rod_side(&m);
        assert_true(fabs(now) > 0.1);
        const int minus = modes[k][1] == '-';
        assert_true(side[minus] == 0 || side[minus] * now > 0);
        side[minus] = now;
        hn_model_close(&m);
    }
    assert_true(side[0] * side[1] < 0);
}

static void open_and_crossed_name_the_first_loop_and_fewer_signs_leave_the_rest(void **state) {
    static const struct {
        const char *asked;
        char first;
    } rows[] = {{"open", '+'}, {"crossed", '-'}, {"-", '-'}, {"+", '+'}};
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[TEXT];
        hn_model m;
        hn_model_open_text(&m, write_scene(text, rows[k].asked, ""), NULL);
        assert_int_equal(m.status, HN_OK);
        assert_int_equal(m.assembly.modes[0], rows[k].first);
        assert_string_equal(m.assembly.mode_name, rows[k].first == '+' ? "open" : "crossed");
        hn_model_close(&m);
    }
}

static void a_mode_that_pins_exclude_is_missed_with_those_found(void **state) {
    char text[TEXT], pin[64];
    hn_model m;
    (void)state;
    snprintf(pin, sizeof pin, ",\"a2\":%.15f", coupler_angle(1) - 1);
    hn_model_open_text(&m, write_scene(text, "-", pin), NULL);
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_non_null(strstr(m.diags.item[0].message, "'-' was not found"));
    assert_non_null(strstr(m.diags.item[0].message, "found: '+"));
    hn_model_close(&m);
}

static void more_signs_than_loops_are_refused(void **state) {
    char text[TEXT];
    hn_model m;
    (void)state;
    hn_model_open_text(&m, write_scene(text, "+-+", ""), NULL);
    assert_int_equal(m.status, HN_ERR_INPUT);
    assert_non_null(strstr(m.diags.item[0].message, "3 signs"));
    hn_model_close(&m);
}

static void a_mode_that_the_guess_leads_to_changes_nothing(void **state) {
    char text[TEXT];
    hn_model any, asked;
    (void)state;
    hn_model_open_text(&any, write_scene(text, NULL, ""), NULL);
    hn_model_open_text(&asked, write_scene(text, any.assembly.modes, ""), NULL);
    assert_all_near(asked.q, any.q, (size_t)any.info.nq, 0);
    assert_string_equal(asked.assembly.route, any.assembly.route);
    hn_model_close(&any);
    hn_model_close(&asked);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mode_of_two_dyads_is_reached_when_asked_for),
        cmocka_unit_test(open_and_crossed_name_the_first_loop_and_fewer_signs_leave_the_rest),
        cmocka_unit_test(a_mode_that_pins_exclude_is_missed_with_those_found),
        cmocka_unit_test(more_signs_than_loops_are_refused),
        cmocka_unit_test(a_mode_that_the_guess_leads_to_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
