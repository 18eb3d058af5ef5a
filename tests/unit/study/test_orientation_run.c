// SPDX-License-Identifier: GPL-3.0-or-later
// Runs with orientations: bodies that turn freely or about a point, against what theory says of
// them.
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "support/motion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 2500 };

/// World vector of a vector in the child's axes, for a rotation vector.
static void turned(const double r[3], const double v[3], double out[3]) {
    const double angle = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    const double c = cos(angle), s = angle > 0 ? sin(angle) / angle : 1;
    const double d = angle > 0 ? (1 - c) / (angle * angle) : 0.5;
    const double along = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = c * v[i] + s * (r[j] * v[k] - r[k] * v[j]) + d * along * r[i];
    }
}

static const char FREE_BODY[] =
    "{\"holonom\":1,\"name\":\"racket\",\"gravity\":[0,0,0],\"bodies\":[{\"name\":\"b\",\"mass\":2,"
    "\"inertia\":{\"xx\":1,\"yy\":2,\"zz\":3}}],\"joints\":[{\"name\":\"F\",\"type\":\"free\","
    "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b\"},"
    "\"coordinates\":[\"x\",\"y\",\"z\",\"rx\",\"ry\",\"rz\"]}],\"start\":{\"positions\":"
    "{\"rx\":{\"guess\":0.3},\"ry\":{\"guess\":-0.4},\"rz\":{\"guess\":1}},"
    "\"rates\":{\"d_x\":0.5,\"d_rx\":0.01,\"d_ry\":2,\"d_rz\":0.02}}}";

static void momentum_of(const double *q, const double *v, double L[3]) {
    const double in_body[3] = {1 * v[3], 2 * v[4], 3 * v[5]};
    turned(q + 3, in_body, L);
}

static void a_body_without_forces_obeys_eulers_equations(void **state) {
    hn_model m;
    double user_a[6];
    (void)state;
    hn_model_open_text(&m, FREE_BODY, NULL);
    assert_int_equal(m.status, HN_OK);
    assert_int_equal(m.info.nq, 7);
    assert_int_equal(m.info.nv, 6);
    hn_system_rates_to_user(m.sys, m.a, user_a);
    const double *w = m.user_v + 3;
    // I1 w1' = (I2 - I3) w2 w3 and cyclic
    const double expected[6] = {
        0, 0, 0, (2 - 3) * w[1] * w[2], (3 - 1) * w[2] * w[0] / 2, (1 - 2) * w[0] * w[1] / 3};
    assert_all_near(user_a, expected, 6, 1e-15);
    hn_model_close(&m);
}

static void a_body_that_turns_about_its_middle_axis_flips_and_keeps_its_momentum(void **state) {
    static const char *const methods[] = {"index1@dopri5:rtol=1e-10",
                                          "projection@dopri5:rtol=1e-10",
                                          "udwadia-kalaba@dopri5:rtol=1e-10", "index1@rk4:h=2e-3"};
    (void)state;
    hn_model m;
    hn_model_open_text(&m, FREE_BODY, NULL);
    double start[3];
    momentum_of(m.user_q, m.user_v, start);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        hn_run *run = hn_motion_start(&m, methods[k]);
        double lowest = 2, highest = -2;
        for (int i = 1; i <= 100; i++) {
            const hn_sample s = hn_motion_at(run, 0.2 * i);
            double L[3];
            momentum_of(s.q, s.v, L);
            assert_all_near(L, start, 3, 2e-8); // of 4 N m s, over 20 s: what the tolerance asks
            assert_near(s.energy_change, 0, 2e-8);
            assert_near(s.q[0], 0.5 * s.t, 1e-11); // the rounding of 10000 sums
            lowest = fmin(lowest, s.v[4]);
            highest = fmax(highest, s.v[4]);
        }
        // w2 swings between +2 and -2: Poinsot's curve around the other axes
        assert_true(lowest < -1.99 && highest > 1.99);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// ---- the heavy top ----

#define TOP_MASS 1.5
#define TOP_ARM 0.4
#define TOP_I1 0.5 // about the tip, across
#define TOP_I3 0.2 // along

/// A symmetric top on its tip, leaning by `lean`, turning with `vertical` about the vertical and
/// `spin` in all about its own axis.
static void open_top(hn_model *m, double lean, double vertical, double spin, int reversed) {
    char text[TEXT];
    const double across = TOP_I1 - TOP_MASS * TOP_ARM * TOP_ARM;
    // the axis leans towards -y: turned by `lean` about x; in body axes the vertical is (0, sin,
    // cos)
    const double w[3] = {0, vertical * sin(lean), spin};
    double rate[3] = {w[0], w[1], w[2]};
    const double r[3] = {lean, 0, 0};
    // the joint's child is the ground: its turn is back, its rates are those of the ground in
    // ground axes
    if (reversed) {
        turned(r, w, rate);
        for (int i = 0; i < 3; i++) {
            rate[i] = -rate[i];
        }
    }
    snprintf(text, sizeof text,
             "{\"holonom\":1,\"name\":\"top\",\"gravity\":[0,0,-9.81],\"bodies\":[{\"name\":"
             "\"top\",\"mass\":%.17g,\"com\":[0,0,%.17g],\"inertia\":{\"xx\":%.17g,\"yy\":%.17g,"
             "\"zz\":%.17g}}],\"joints\":[{\"name\":\"S\",\"type\":\"spherical\",\"parent\":"
             "{\"body\":\"%s\"},\"child\":{\"body\":\"%s\"},\"coordinates\":[\"rx\",\"ry\","
             "\"rz\"]}],\"start\":{\"positions\":{\"rx\":%.17g,\"ry\":0,\"rz\":0},\"rates\":"
             "{\"d_rx\":%.17g,\"d_ry\":%.17g,\"d_rz\":%.17g}}}",
             TOP_MASS, TOP_ARM, across, across, TOP_I3, reversed ? "top" : "ground",
             reversed ? "ground" : "top", reversed ? -lean : lean, rate[0], rate[1], rate[2]);
    hn_model_open_text(m, text, NULL);
    assert_int_equal(m->status, HN_OK);
}

/// Spin in all for which a top at `lean` precesses steadily: I1 W^2 cos - I3 s W + m g l = 0.
static double steady_spin(double lean, double vertical) {
    return (TOP_I1 * vertical * vertical * cos(lean) + TOP_MASS * 9.81 * TOP_ARM) /
           (TOP_I3 * vertical);
}

static void a_top_precesses_steadily_at_the_spin_that_theory_gives(void **state) {
    const double lean = 0.7, vertical = 1.9;
    (void)state;
    for (int reversed = 0; reversed < 2; reversed++) {
        hn_model m;
        open_top(&m, lean, vertical, steady_spin(lean, vertical), reversed);
        hn_run *run = hn_motion_start(&m, "index1@dop853:rtol=1e-12");
        for (int i = 1; i <= 10; i++) {
            const hn_sample s = hn_motion_at(run, 0.37 * i);
            const double z[3] = {0, 0, 1};
            double r[3] = {s.q[0], s.q[1], s.q[2]}, axis[3];
            for (int k = 0; k < 3 && reversed; k++) {
                r[k] = -r[k];
            }
            turned(r, z, axis);
            const double angle = vertical * s.t;
            const double expected[3] = {sin(lean) * sin(angle), -sin(lean) * cos(angle), cos(lean)};
            assert_all_near(axis, expected, 3,
                            1e-9); // about 20 turns of its own at 1e-12 each step
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void a_nodding_top_keeps_energy_vertical_momentum_and_spin(void **state) {
    hn_model m;
    (void)state;
    open_top(&m, 0.9, 0.4, 11, 0);
    hn_run *run = hn_motion_start(&m, "projection@dopri5:rtol=1e-10");
    const double across = TOP_I1;
    double start = 0, lowest = 10, highest = 0;
    for (int i = 0; i <= 60; i++) {
        const hn_sample s = hn_motion_at(run, 0.1 * i);
        const double in_body[3] = {across * s.v[0], across * s.v[1], TOP_I3 * s.v[2]};
        const double z[3] = {0, 0, 1};
        double L[3], axis[3];
        turned(s.q, in_body, L);
        turned(s.q, z, axis);
        start = i ? start : L[2];
        assert_near(L[2], start, 1e-7);
        assert_near(s.v[2], 11, 1e-12); // no moment about its own axis: to rounding
        assert_near(s.energy_change, 0, 1e-7);
        lowest = fmin(lowest, acos(axis[2]));
        highest = fmax(highest, acos(axis[2]));
    }
    assert_true(highest - lowest > 0.1); // it does nod
    hn_run_free(run);
    hn_model_close(&m);
}

// ---- joints that can be said in two ways ----

static void a_body_on_a_fixed_joint_moves_as_part_of_what_carries_it(void **state) {
    static const char *const texts[2] = {
        "{\"holonom\":1,\"name\":\"two\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"a\","
        "\"mass\":2,\"com\":[0.5,0,0],\"inertia\":{\"zz\":0.2}},{\"name\":\"b\",\"mass\":3,"
        "\"com\":[0.1,0,0],\"inertia\":{\"zz\":0.1}}],\"joints\":[{\"name\":\"A\",\"type\":"
        "\"revolute\",\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"a\"},"
        "\"coordinate\":\"th\"},{\"name\":\"W\",\"type\":\"fixed\",\"parent\":{\"body\":\"a\","
        "\"at\":[1,0,0]},\"child\":{\"body\":\"b\"}}],\"start\":{\"positions\":{\"th\":0.3},"
        "\"rates\":{\"d_th\":2}}}",
        // one body: mass 5, first moment 2*0.5 + 3*1.1, inertia about the pivot 0.2 + 0.5 + 0.1 +
        // 3.63
        "{\"holonom\":1,\"name\":\"one\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"ab\","
        "\"mass\":5,\"com\":[0.86,0,0],\"inertia\":{\"zz\":0.732}}],\"joints\":[{\"name\":\"A\","
        "\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"ab\"},"
        "\"coordinate\":\"th\"}],\"start\":{\"positions\":{\"th\":0.3},\"rates\":{\"d_th\":2}}}"};
    double a[2], energy[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_text(&m, texts[k], NULL);
        assert_int_equal(m.info.nv, 1);
        a[k] = m.a[0];
        energy[k] = m.assembly.energy;
        hn_model_close(&m);
    }
    assert_near(a[1], -9.81 * 4.3 * cos(0.3) / 4.43, 1e-14);
    assert_near(a[0], a[1], 1e-14);
    assert_near(energy[0], energy[1], 1e-13);
}

static void a_universal_joint_is_two_revolutes_about_a_cross_without_mass(void **state) {
    static const char body[] = "\"mass\":2,\"com\":[0.3,0.2,-0.5],\"inertia\":{\"xx\":0.3,\"yy\":0."
                               "4,\"zz\":0.25,\"xy\":0.05}}";
    static const char start[] = "\"start\":{\"positions\":{\"p\":0.4,\"s\":-0.7},\"rates\":{\"vp\":"
                                "1.1,\"vs\":-2.3}}}";
    char texts[2][TEXT];
    double a[2][2];
    (void)state;
    snprintf(
        texts[0], TEXT,
        "{\"holonom\":1,\"name\":\"u\",\"gravity\":[0,0,-9.81],\"bodies\":[{\"name\":\"b\",%s],"
        "\"joints\":[{\"name\":\"U\",\"type\":\"universal\",\"axis\":[1,0,0],\"axis2\":"
        "[0,1,0],\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b\"},"
        "\"coordinates\":[\"p\",\"s\"],\"rates\":[\"vp\",\"vs\"]}],%s",
        body, start);
    snprintf(texts[1], TEXT,
             "{\"holonom\":1,\"name\":\"rr\",\"gravity\":[0,0,-9.81],\"bodies\":[{\"name\":\"x\","
             "\"mass\":1e-13},{\"name\":\"b\",%s],\"joints\":[{\"name\":\"A\",\"type\":"
             "\"revolute\",\"axis\":[1,0,0],\"parent\":{\"body\":\"ground\"},\"child\":"
             "{\"body\":\"x\"},\"coordinate\":\"p\",\"rate\":\"vp\"},{\"name\":\"B\",\"type\":"
             "\"revolute\",\"axis\":[0,1,0],\"parent\":{\"body\":\"x\"},\"child\":{\"body\":\"b\"},"
             "\"coordinate\":\"s\",\"rate\":\"vs\"}],%s",
             body, start);
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_text(&m, texts[k], NULL);
        assert_int_equal(m.status, HN_OK);
        hn_system_rates_to_user(m.sys, m.a, a[k]);
        hn_model_close(&m);
    }
    assert_all_near(a[0], a[1], 2, 1e-11);
}

static void a_body_on_a_cylindrical_joint_falls_and_turns_as_a_screw(void **state) {
    hn_model m;
    (void)state;
    hn_model_open_text(
        &m,
        "{\"holonom\":1,\"name\":\"screw\",\"gravity\":[0,0,-9.81],\"bodies\":[{\"name\":\"b\","
        "\"mass\":2,\"com\":[0.4,0.1,0.3],\"inertia\":{\"xx\":1,\"yy\":2,\"zz\":1.4,\"xz\":0.2}}],"
        "\"joints\":[{\"name\":\"C\",\"type\":\"cylindrical\",\"axis\":[0,0,1],\"parent\":"
        "{\"body\":\"ground\"},\"child\":{\"body\":\"b\"},\"coordinates\":[\"th\",\"z\"]}],"
        "\"start\":{\"positions\":{\"th\":0.2,\"z\":1},\"rates\":{\"d_th\":3,\"d_z\":0.5}}}",
        NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.01");
    const hn_sample s = hn_motion_at(run, 1);
    const double expected[4] = {3.2, 1 + 0.5 - 9.81 / 2, 3, 0.5 - 9.81};
    const double found[4] = {s.q[0], s.q[1], s.v[0], s.v[1]};
    assert_all_near(found, expected, 4, 1e-12); // RK4 is exact for a parabola
    hn_run_free(run);
    hn_model_close(&m);
}

// a four-bar in which the link that turns all the way hangs on a ball and is kept in its plane: th
// only rocks
static const char FOUR_BAR_WITH_A_BALL[] =
    "{\"holonom\":1,\"name\":\"ball four-bar\",\"gravity\":[0,0,0],"
    "\"bodies\":[{\"name\":\"rocker\",\"mass\":1,\"com\":[0.5,0,0],\"inertia\":{\"xx\":0.01,"
    "\"yy\":0.1,\"zz\":0.1}},{\"name\":\"arm\",\"mass\":1,\"com\":[0.1,0,0],"
    "\"inertia\":{\"xx\":0.02,\"yy\":0.03,\"zz\":0.04}}],\"joints\":[{\"name\":\"O\","
    "\"type\":\"revolute\",\"axis\":[0,0,1],\"coordinate\":\"th\","
    "\"parent\":{\"body\":\"ground\",\"at\":[0,0,0]},\"child\":{\"body\":\"rocker\",\"at\":[0,"
    "0,0]}},{\"name\":\"S\",\"type\":\"spherical\",\"parent\":{\"body\":\"ground\",\"at\":[1,0,"
    "0]},\"child\":{\"body\":\"arm\",\"at\":[0,0,0]}}],\"constraints\":[{\"name\":\"rod\","
    "\"distance\":{\"from\":{\"body\":\"rocker\",\"at\":[1,0,0]},\"to\":{\"body\":\"arm\","
    "\"at\":[0.3,0,0]},\"length\":0.9}},{\"name\":\"flat 1\","
    "\"plane\":{\"point\":{\"body\":\"arm\",\"at\":[1,0,0]},\"through\":{\"body\":\"ground\","
    "\"at\":[0,0,0]},\"direction\":[0,0,1]}},{\"name\":\"flat 2\","
    "\"plane\":{\"point\":{\"body\":\"arm\",\"at\":[0,1,0]},\"through\":{\"body\":\"ground\","
    "\"at\":[0,0,0]},\"direction\":[0,0,1]}}],\"start\":{\"positions\":{\"th\":1.2},"
    "\"rates\":{\"d_th\":3}}}";

static void coordinates_that_end_where_only_a_ball_could_follow_say_so(void **state) {
    static const char *const methods[] = {"partitioning@rk4:h=2e-3", "partitioning@rk4:h=2e-4",
                                          "partitioning@dopri5", "reduced@rk4:h=1e-3"};
    (void)state;
    hn_model m;
    hn_model_open_text(&m, FOUR_BAR_WITH_A_BALL, NULL);
    assert_int_equal(m.status, HN_OK);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        const hn_incident *incidents;
        hn_run *run = hn_motion_start(&m, methods[i]);
        assert_int_equal(hn_run_advance(run, 1), HN_ERR_UNSUPPORTED);
        const int n = hn_run_incidents(run, &incidents);
        assert_true(n > 0);
        const hn_incident *last = &incidents[n - 1];
        assert_int_equal(last->code, HN_INCIDENT_CHART_LOST);
        assert_non_null(strstr(last->message, "the rotation of S would have to be independent"));
        // no shorter step brings such a coordinate: other methods are what helps, and they do
        for (int k = 0; k < 3 && last->remedy[k][0]; k++) {
            assert_non_null(strchr(last->remedy[k], '@'));
            hn_run *other = hn_motion_start(&m, last->remedy[k]);
            assert_int_equal(hn_run_advance(other, 1), HN_OK);
            hn_run_free(other);
        }
        assert_true(last->remedy[0][0] != 0);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void a_multistep_method_that_starts_again_after_every_step_says_so(void **state) {
    // projection changes the state of a loop, a ball's quaternion is brought back to length 1;
    // baumgarte leaves the state alone
    static const struct {
        const char *scene, *method;
        int told;
    } rows[] = {{"fb0", "projection@gsl-msadams", 1},      {"fb0", "projection@gsl-msbdf", 1},
                {"fb0", "baumgarte@gsl-msadams", 0},       {"fb0", "projection@gsl-rk8pd", 0},
                {"heavy-top", "index1@gsl-msadams", 1},    {"heavy-top", "index1@dopri5", 0},
                {"double-pendulum", "index1@gsl-msbdf", 0}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_model m;
        const hn_incident *incidents;
        hn_model_open_closed(&m, rows[i].scene, NULL);
        hn_run *run = hn_motion_start(&m, rows[i].method);
        assert_int_equal(hn_run_advance(run, 0.1), HN_OK);
        int told = 0;
        const int n = hn_run_incidents(run, &incidents);
        for (int k = 0; k < n; k++) {
            told += incidents[k].code == HN_INCIDENT_RESTARTS;
        }
        assert_int_equal(told, rows[i].told);
        hn_run_free(run);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_without_forces_obeys_eulers_equations),
        cmocka_unit_test(a_body_that_turns_about_its_middle_axis_flips_and_keeps_its_momentum),
        cmocka_unit_test(a_top_precesses_steadily_at_the_spin_that_theory_gives),
        cmocka_unit_test(a_nodding_top_keeps_energy_vertical_momentum_and_spin),
        cmocka_unit_test(a_body_on_a_fixed_joint_moves_as_part_of_what_carries_it),
        cmocka_unit_test(a_universal_joint_is_two_revolutes_about_a_cross_without_mass),
        cmocka_unit_test(a_body_on_a_cylindrical_joint_falls_and_turns_as_a_screw),
        cmocka_unit_test(coordinates_that_end_where_only_a_ball_could_follow_say_so),
        cmocka_unit_test(a_multistep_method_that_starts_again_after_every_step_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
