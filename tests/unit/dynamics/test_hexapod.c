// SPDX-License-Identifier: GPL-3.0-or-later
// The hexapod of Stewart and Gough, base joints 15 degrees off three axes, platform joints 45
// degrees: sizes, freedoms, its singular pose (Fichter 1986: the platform turned by a right angle),
// and what its equations cost. Every body's frame is the world's at the pose, so that the ring of
// every leg is closed with all joints at zero.
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 16000 };

typedef struct pen {
    char *text;
    size_t used;
} pen;

static void put(pen *p, const char *more) {
    assert_true(p->used + strlen(more) < TEXT);
    strcpy(p->text + p->used, more);
    p->used += strlen(more);
}

static void corner(int leg, double half_angle, double radius, double turned, double at[3]) {
    const double a = leg / 2 * 2 * M_PI / 3 + (leg % 2 ? 1 : -1) * half_angle + turned;
    at[0] = radius * cos(a);
    at[1] = radius * sin(a);
}

static void put_leg(pen *p, int leg, double yaw, int sliding) {
    char more[1500], middle[300] = "";
    double b[3] = {0, 0, 0}, t[3] = {0, 0, 1};
    corner(leg, M_PI / 12, 1, 0, b);
    corner(leg, M_PI / 4, 0.6, yaw, t);
    const double u[3] = {t[0] - b[0], t[1] - b[1], t[2] - b[2]};
    const char *top = sliding ? "rod" : "leg";
    if (sliding) {
        snprintf(middle, sizeof middle,
                 "{\"name\":\"P%d\",\"type\":\"prismatic\",\"axis\":[%.17g,%.17g,%.17g],\"parent\":"
                 "{\"body\":\"leg%d\",\"at\":[%.17g,%.17g,0]},\"child\":{\"body\":\"rod%d\",\"at\":"
                 "[%.17g,%.17g,0]}},",
                 leg, u[0], u[1], u[2], leg, b[0], b[1], leg, b[0], b[1]);
    }
    snprintf(more, sizeof more,
             ",{\"name\":\"U%d\",\"type\":\"universal\",\"axis\":[%.17g,%.17g,0],\"axis2\":"
             "[%.17g,%.17g,%.17g],\"parent\":{\"body\":\"ground\",\"at\":[%.17g,%.17g,0]},"
             "\"child\":{\"body\":\"leg%d\",\"at\":[%.17g,%.17g,0]}},%s"
             "{\"name\":\"S%d\",\"type\":\"spherical\",\"cut\":true,\"parent\":{\"body\":\"%s%d\","
             "\"at\":[%.17g,%.17g,1]},\"child\":{\"body\":\"platform\",\"at\":[%.17g,%.17g,1]}}",
             leg, u[1], -u[0], u[0] * u[2], u[1] * u[2], -u[0] * u[0] - u[1] * u[1], b[0], b[1],
             leg, b[0], b[1], middle, leg, top, leg, t[0], t[1], t[0], t[1]);
    put(p, more);
}

static void open_hexapod(hn_model *m, double yaw, int sliding) {
    static char text[TEXT];
    pen p = {text, 0};
    put(&p, "{\"holonom\":1,\"name\":\"hexapod\",\"gravity\":[0,0,-9.81],\"bodies\":[{\"name\":"
            "\"platform\",\"mass\":5,\"com\":[0,0,1],\"inertia\":{\"xx\":0.4,\"yy\":0.4,\"zz\":"
            "0.8}}");
    for (int leg = 0; leg < 6; leg++) {
        char more[400];
        double b[3] = {0, 0, 0};
        corner(leg, M_PI / 12, 1, 0, b);
        snprintf(more, sizeof more,
                 ",{\"name\":\"leg%d\",\"mass\":1,\"com\":[%.17g,%.17g,0.3],\"inertia\":{\"xx\":"
                 "0.03,\"yy\":0.03,\"zz\":0.01}}",
                 leg, 0.8 * b[0], 0.8 * b[1]);
        put(&p, more);
        if (sliding) {
            snprintf(more, sizeof more,
                     ",{\"name\":\"rod%d\",\"mass\":0.5,\"com\":[%.17g,%.17g,0.7],\"inertia\":"
                     "{\"xx\":0.02,\"yy\":0.02,\"zz\":0.01}}",
                     leg, 0.6 * b[0], 0.6 * b[1]);
            put(&p, more);
        }
    }
    put(&p, "],\"joints\":[{\"name\":\"F\",\"type\":\"free\",\"parent\":{\"body\":\"ground\"},"
            "\"child\":{\"body\":\"platform\"}}");
    for (int leg = 0; leg < 6; leg++) {
        put_leg(&p, leg, yaw, sliding);
    }
    put(&p, "]}");
    hn_model_open_text(m, text, NULL);
}

static void six_sliding_legs_leave_the_platform_its_six_freedoms(void **state) {
    hn_model m;
    (void)state;
    open_hexapod(&m, 1, 1);
    assert_int_equal(m.status, HN_OK);
    assert_int_equal(m.info.nv, 24);
    assert_int_equal(m.info.nq, 25);
    assert_int_equal(m.info.nc, 18);
    assert_int_equal(m.assembly.freedoms, 6);
    assert_true(m.assembly.gap < 1e-14);
    hn_model_close(&m);
}

static void rigid_legs_hold_the_platform_except_when_it_is_turned_by_a_right_angle(void **state) {
    static const double degrees[] = {0, 30, 60, 80, 89, 90};
    double sigma[6];
    (void)state;
    for (int k = 0; k < 6; k++) {
        hn_model m;
        open_hexapod(&m, degrees[k] * M_PI / 180, 0);
        assert_int_equal(m.info.nv, 18);
        assert_int_equal(m.info.nc, 18);
        assert_int_equal(m.assembly.freedoms, degrees[k] == 90);
        assert_int_equal(m.assembly.redundant, degrees[k] == 90);
        sigma[k] = m.assembly.sigma_min;
        hn_model_close(&m);
    }
    assert_true(sigma[0] > sigma[2] && sigma[2] > sigma[3] && sigma[3] > sigma[4]);
    // it dies away with the cosine of the yaw; what is left of the angle in J changes it by a few
    // per cent
    assert_rel(sigma[4] / sigma[3], cos(89 * M_PI / 180) / cos(80 * M_PI / 180), 0.07);
}

static void the_legs_stay_apart_in_the_elimination(void **state) {
    hn_model m;
    hn_accel *accel;
    (void)state;
    open_hexapod(&m, 0.3, 1);
    const hn_accel_opts opts = {.want_lambda = 1};
    assert_int_equal(hn_accel_create(m.sys, &opts, m.arena, &accel), HN_OK);
    // 9300 when each leg's rows wait for the platform and so meet all others
    assert_true(hn_accel_tape_info(accel).ops < 6200);
    double a[24], lambda[18], user[24], expected[24];
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(accel, 0, m.q, m.v, 0, 0, a, lambda, &info), HN_OK);
    assert_int_equal(info.fallback, 0);
    // nothing but gravity acts from rest: by symmetry of the legs' masses about the vertical axis
    // the platform falls straight
    hn_system_rates_to_user(m.sys, a, user);
    hn_system_rates_to_user(m.sys, m.a, expected);
    assert_all_near(user, expected, 24, 1e-11);
    assert_near(user[hn_model_user(&m, "F_x")], 0, 1e-11);
    assert_near(user[hn_model_user(&m, "F_y")], 0, 1e-11);
    assert_true(user[hn_model_user(&m, "F_z")] < -1);
    hn_accel_free(accel);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(six_sliding_legs_leave_the_platform_its_six_freedoms),
        cmocka_unit_test(rigid_legs_hold_the_platform_except_when_it_is_turned_by_a_right_angle),
        cmocka_unit_test(the_legs_stay_apart_in_the_elimination),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
