// SPDX-License-Identifier: GPL-3.0-or-later
// Mass, centre and inertia of what is read against numbers worked out by hand.
#include "support/near.h"

#include "import/frame.h"
#include "support/imported.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static void check_body(const hn_imported *x, const char *name, double m, const double com[3],
                       const double I[6]) {
    const hn_body *b = &x->scene->bodies[imported_body(x, name)];
    assert_rel(b->mass.value, m, 1e-14);
    for (int i = 0; i < 3; i++) {
        assert_near(b->com[i].value, com[i], 1e-14);
    }
    for (int k = 0; k < 6; k++) {
        assert_near(b->inertia[k].value, I[k], 1e-13 * (I[0] + I[1] + I[2]));
    }
}

#define BODY(inside) \
    "<mujoco><worldbody><body name='b'><joint/>" inside "</body></worldbody></mujoco>"

static void a_sphere_has_the_density_of_water_when_nothing_is_said(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x, BODY("<geom size='0.1' pos='0.3 0 0'/>"), NULL);
    double m = 1000 * 4 * PI / 3 * 1e-3, I = 0.4 * m * 0.01;
    check_body(&x, "b", m, (double[]){0.3, 0, 0}, (double[]){I, I, I, 0, 0, 0});
    imported_close(&x);
}

static void a_capsule_between_two_ends_is_a_cylinder_and_two_half_balls(void **state) {
    (void)state;
    hn_imported x;
    imported_open(
        &x, BODY("<geom type='capsule' fromto='0 0 0 0.8 0 0' size='0.1' density='500'/>"), NULL);
    // the half balls' mass lies 3/8 r beyond the ends: I = I_ball + m (h + 3/8 r)^2 - m (3/8 r)^2
    double mc = 500 * PI * 0.01 * 0.8, ms = 500 * 4 * PI / 3 * 1e-3;
    double along = mc * 0.01 / 2 + 0.4 * ms * 0.01;
    double across =
        mc * (3 * 0.01 + 0.64) / 12 + ms * (0.4 * 0.01 - pow(0.0375, 2) + pow(0.4375, 2));
    check_body(&x, "b", mc + ms, (double[]){0.4, 0, 0}, (double[]){along, across, across, 0, 0, 0});
    imported_close(&x);
}

static void a_turned_box_has_products_of_inertia(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x, BODY("<geom type='box' size='0.3 0.2 0.1' mass='6' euler='0 0 30'/>"), NULL);
    double a = 2 * (0.04 + 0.01), b = 2 * (0.09 + 0.01), c = 2 * (0.09 + 0.04);
    double xx = a * 0.75 + b * 0.25, yy = a * 0.25 + b * 0.75, xy = (a - b) * sqrt(3) / 4;
    check_body(&x, "b", 6, (double[]){0, 0, 0}, (double[]){xx, yy, c, xy, 0, 0});
    imported_close(&x);
}

static void cylinder_and_ellipsoid_follow_their_formulas(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x, BODY("<geom type='cylinder' size='0.1 0.3' mass='2'/>"), NULL);
    double across = 2 * (3 * 0.01 + 0.36) / 12;
    check_body(&x, "b", 2, (double[]){0, 0, 0}, (double[]){across, across, 0.01, 0, 0, 0});
    imported_close(&x);
    imported_open(&x, BODY("<geom type='ellipsoid' size='0.1 0.2 0.3' density='100'/>"), NULL);
    double m = 100 * 4 * PI / 3 * 0.006;
    check_body(&x, "b", m, (double[]){0, 0, 0},
               (double[]){m * 0.13 / 5, m * 0.1 / 5, m * 0.05 / 5, 0, 0, 0});
    imported_close(&x);
}

static void two_geoms_are_one_body_by_steiner(void **state) {
    (void)state;
    hn_imported x;
    imported_open(
        &x, BODY("<geom size='0.1' mass='1' pos='1 0 0'/><geom size='0.1' mass='3' pos='0 1 0'/>"),
        NULL);
    // reduced mass 3/4 at the distance sqrt 2 along (1, -1, 0)
    double ball = 0.4 * 4 * 0.01, mu = 0.75;
    check_body(&x, "b", 4, (double[]){0.25, 0.75, 0},
               (double[]){ball + mu, ball + mu, ball + 2 * mu, mu, 0, 0});
    hn_import_info info = hn_import_get_info(x.im);
    assert_rel(info.mass, 4, 1e-15);
    assert_all_near(info.com, ((double[]){0.25, 0.75, 0}), 3, 1e-15);
    imported_close(&x);
}

static void an_inertial_speaks_before_geoms_unless_told_otherwise(void **state) {
    (void)state;
    static const char inside[] = "<worldbody><body name='b'><joint/><inertial pos='0 0 1' mass='2' "
                                 "fullinertia='3 4 5 0.1 0.2 0.3'/><geom size='0.1' mass='7'/>"
                                 "</body></worldbody></mujoco>";
    char text[512];
    hn_imported x;
    (void)snprintf(text, sizeof text, "<mujoco>%s", inside);
    imported_open(&x, text, NULL);
    check_body(&x, "b", 2, (double[]){0, 0, 1}, (double[]){3, 4, 5, 0.1, 0.2, 0.3});
    imported_close(&x);
    (void)snprintf(text, sizeof text, "<mujoco><compiler inertiafromgeom='true'/>%s", inside);
    imported_open(&x, text, NULL);
    check_body(&x, "b", 7, (double[]){0, 0, 0}, (double[]){0.028, 0.028, 0.028, 0, 0, 0});
    assert_non_null(imported_note(&x, "/inertial"));
    imported_close(&x);
}

static void settotalmass_scales_every_body(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><compiler settotalmass='8'/><worldbody><body name='b'><joint/>"
                  "<geom size='0.1' mass='1'/><body name='c'><joint/><geom size='0.1' mass='3'/>"
                  "</body></body></worldbody></mujoco>",
                  NULL);
    check_body(&x, "b", 2, (double[]){0, 0, 0}, (double[]){0.008, 0.008, 0.008, 0, 0, 0});
    check_body(&x, "c", 6, (double[]){0, 0, 0}, (double[]){0.024, 0.024, 0.024, 0, 0, 0});
    imported_close(&x);
}

static void the_inertia_of_a_urdf_link_is_turned_by_its_origin(void **state) {
    (void)state;
    hn_imported x;
    imported_open(
        &x,
        "<robot name='r'><link name='b'><inertial><origin xyz='1 2 3' rpy='0 0 "
        "1.5707963267948966'/><mass value='2'/><inertia ixx='3' iyy='4' izz='5' ixy='0.5' "
        "ixz='0.2' iyz='0.1'/></inertial></link></robot>",
        NULL);
    // a quarter turn about z: x' = y, y' = -x
    check_body(&x, "b", 2, (double[]){1, 2, 3}, (double[]){4, 3, 5, -0.5, -0.1, 0.2});
    imported_close(&x);
}

static void a_rotation_vector_gives_its_rotation_back(void **state) {
    (void)state;
    for (int k = 0; k <= 20; k++) {
        double axis[3] = {0.3, -0.7, 0.2 + 0.1 * k}, R[3][3], back[3], angle = PI * k / 20;
        assert_true(hn_im_normalise(axis));
        hn_im_rotation(axis, angle, R);
        hn_im_rotation_vector(R, back);
        // near a half turn the axis is known to the square root of rounding only up to its sign
        double sign = k == 20 && back[2] * axis[2] < 0 ? -1 : 1;
        for (int i = 0; i < 3; i++) {
            assert_near(sign * back[i], angle * axis[i], 4e-15);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_has_the_density_of_water_when_nothing_is_said),
        cmocka_unit_test(a_capsule_between_two_ends_is_a_cylinder_and_two_half_balls),
        cmocka_unit_test(a_turned_box_has_products_of_inertia),
        cmocka_unit_test(cylinder_and_ellipsoid_follow_their_formulas),
        cmocka_unit_test(two_geoms_are_one_body_by_steiner),
        cmocka_unit_test(an_inertial_speaks_before_geoms_unless_told_otherwise),
        cmocka_unit_test(settotalmass_scales_every_body),
        cmocka_unit_test(the_inertia_of_a_urdf_link_is_turned_by_its_origin),
        cmocka_unit_test(a_rotation_vector_gives_its_rotation_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
