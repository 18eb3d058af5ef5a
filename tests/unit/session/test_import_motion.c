// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms read from other programs' files move as the same mechanisms written by hand.
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "import/import.h"
#include "support/imported.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void open_import(hn_model *m, const hn_imported *x) {
    size_t n;
    hn_model_open_text(m, hn_import_scene(x->im, &n), NULL);
    if (m->status != HN_OK) {
        fail_msg("assemble: %s", m->diags.n ? m->diags.item[0].message : "");
    }
}

/// Two links in the world's x-z plane, turned about y by angles p1 and p2, written as formulas of a
/// Lagrangian.
static const char BY_HAND[] =
    "{\"holonom\": 1, \"name\": \"by-hand\", \"lagrangian\": {"
    "\"coordinates\": [{\"name\": \"p1\", \"rate\": \"w1\"}, {\"name\": \"p2\", \"rate\": \"w2\"}],"
    // upper: com 0.25 along its x; lower: joint at 0.5, com (0.2, 0.1) in its x and z; y turns x to
    // -z
    "\"kinetic\": \"1.2*0.25^2*w1^2/2 + 0.025*w1^2/2 + 0.03*(w1 + w2)^2/2 + 0.8/2*(0.25*w1^2 + "
    "(0.2^2 + 0.1^2)*(w1 + w2)^2 + 2*0.5*w1*(w1 + w2)*(0.2*cos(p2) + 0.1*sin(p2)))\","
    "\"potential\": \"-1.2*9.81*0.25*sin(p1) + 0.8*9.81*(-0.5*sin(p1) - 0.2*sin(p1 + p2) + "
    "0.1*cos(p1 + p2))\","
    "\"forces\": {\"p1\": \"-0.05*w1\", \"p2\": \"-1.5*(p2 - 0.2)\"}},"
    "\"start\": {\"positions\": {\"p1\": 0.3, \"p2\": -0.4}, \"rates\": {\"p1\": 1, \"p2\": -2}}}";

static const char MJCF[] =
    "<mujoco><compiler angle='radian'/><worldbody><body name='upper'><joint name='p1' axis='0 1 0' "
    "damping='0.05'/><inertial pos='0.25 0 0' mass='1.2' diaginertia='0.02 0.025 0.02'/>"
    "<body name='lower' pos='0.5 0 0'><joint name='p2' axis='0 1 0' stiffness='1.5' "
    "springref='0.2'/><inertial pos='0.2 0 0.1' mass='0.8' diaginertia='0.03 0.03 0.03'/></body>"
    "</body></worldbody><keyframe><key qpos='0.3 -0.4' qvel='1 -2'/></keyframe></mujoco>";

static void a_double_pendulum_has_the_accelerations_of_its_lagrangian(void **state) {
    (void)state;
    hn_model ours, theirs;
    hn_imported x;
    hn_model_open_text(&ours, BY_HAND, NULL);
    assert_int_equal(ours.status, HN_OK);
    imported_open(&x, MJCF, NULL);
    open_import(&theirs, &x);
    double a[2], b[2];
    hn_system_rates_to_user(ours.sys, ours.a, a);
    hn_system_rates_to_user(theirs.sys, theirs.a, b);
    assert_true(fabs(a[0]) > 1 && fabs(a[1]) > 1);
    assert_all_near(b, a, 2, 1e-12 * fmax(fabs(a[0]), fabs(a[1])));
    hn_model_close(&ours);
    hn_model_close(&theirs);
    imported_close(&x);
}

/// The same links, joints and frames once as URDF and once as MJCF.
static void urdf_and_mjcf_of_one_mechanism_move_alike(void **state) {
    (void)state;
    static const char mjcf[] =
        "<mujoco><compiler angle='radian' eulerseq='XYZ'/><worldbody><body name='base'><body "
        "name='upper' pos='0.1 0 2' euler='0.1 0.2 0.3'><joint name='p1' axis='0 1 0' "
        "damping='0.05'/><inertial pos='0.25 0 0' mass='1.2' diaginertia='0.001 0.025 0.025'/>"
        "<body name='lower' pos='0.5 0 0' euler='0 0.7 0'><joint name='p2' axis='0 1 1'/>"
        "<inertial pos='0.2 0.01 0' mass='0.8' euler='0.3 -0.2 0.5' fullinertia='0.004 0.012 0.011 "
        "0.0005 -0.0002 0.0003'/></body></body></body></worldbody></mujoco>";
    hn_model a, b;
    hn_imported x, y;
    imported_open(&x, mjcf, NULL);
    imported_open_file(&y, "double-pendulum.urdf", NULL, NULL);
    open_import(&a, &x);
    open_import(&b, &y);
    assert_int_equal(a.info.n_user, 2);
    double ua[2], ub[2];
    hn_system_rates_to_user(a.sys, a.a, ua);
    hn_system_rates_to_user(b.sys, b.a, ub);
    assert_true(fabs(ua[0]) > 1);
    assert_all_near(ub, ua, 2, 1e-12 * fabs(ua[0]));
    hn_model_close(&a);
    hn_model_close(&b);
    imported_close(&x);
    imported_close(&y);
}

/// The lesson's scene with the crank at 60 degrees and at rest.
static void open_own(hn_model *m) {
    enum { ROOM = 1 << 14 };
    static const char start[] = "\"positions\": {\"th1\": 1,", rates[] = "\"rates\": {\"th1\": 2}";
    char text[ROOM] = "", changed[ROOM + 64];
    FILE *f = fopen("lessons/01-closed-loops/scenes/fb0.json", "rb");
    assert_non_null(f);
    assert_true(fread(text, 1, ROOM - 1, f) < ROOM - 1);
    (void)fclose(f);
    char *a = strstr(text, start), *b = strstr(text, rates);
    assert_non_null(a);
    assert_non_null(b);
    (void)snprintf(changed, sizeof changed,
                   "%.*s\"positions\": {\"th1\": 1.0471975511965976,%.*s\"rates\": {\"th1\": 0}%s",
                   (int)(a - text), text, (int)(b - a - (long)strlen(start)), a + strlen(start),
                   b + strlen(rates));
    hn_model_open_text(m, changed, NULL);
    assert_int_equal(m->status, HN_OK);
}

static double acceleration(const hn_model *m, const char *name) {
    double a[16];
    assert_true(m->info.n_user <= 16);
    hn_system_rates_to_user(m->sys, m->a, a);
    return a[hn_model_user(m, name)];
}

/// FB0's lengths and masses, at the pose of the file, by the lesson's own scene.
static void a_four_bar_closed_by_connect_moves_as_our_own(void **state) {
    (void)state;
    hn_model ours, theirs, from_urdf;
    hn_imported x, y;
    open_own(&ours);
    imported_open_file(&x, "four-bar.xml", NULL, NULL);
    open_import(&theirs, &x);
    imported_open_file(&y, "four-bar.urdf", "four-bar.loops.json", NULL);
    open_import(&from_urdf, &y);
    // in space a ball closes with three rows; the one across the plane is 0 whatever the pose
    assert_int_equal(theirs.info.rows_before, 3);
    assert_int_equal(theirs.info.rows_dropped, 1);
    assert_int_equal(from_urdf.info.rows_before, 5);
    assert_int_equal(from_urdf.info.rows_dropped, 3);
    assert_int_equal(theirs.assembly.freedoms, 1);
    assert_int_equal(from_urdf.assembly.freedoms, 1);
    assert_near(theirs.assembly.gap, 0, 1e-14);
    // the file is drawn closed: nothing had to move
    assert_near(theirs.assembly.moved, 0, 1e-14);
    assert_near(theirs.user_q[hn_model_user(&theirs, "th1")], 1.0471975511965976, 1e-15);
    double expected = acceleration(&ours, "th1");
    assert_true(fabs(expected) > 1);
    assert_rel(acceleration(&theirs, "th1"), expected, 1e-12);
    // th3 and a2 are counted from other places, and accelerate alike
    assert_rel(acceleration(&theirs, "th3"), acceleration(&ours, "th3"), 1e-12);
    assert_rel(acceleration(&theirs, "a2"), acceleration(&ours, "a2"), 1e-12);
    hn_model_close(&ours);
    hn_model_close(&theirs);
    hn_model_close(&from_urdf);
    imported_close(&x);
    imported_close(&y);
}

/// Freedoms counted by hand: Stewart 6 + 6*3 - 6*3; leg 8 speeds, 3 rows of the ball, 1 of the
/// coupling.
static void spatial_loops_close_where_the_file_is_drawn(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int speeds, rows, freedoms;
    } expected[] = {{"stewart.xml", 24, 18, 6}, {"leg.xml", 8, 4, 4}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        hn_imported x;
        hn_model m;
        imported_open_file(&x, expected[i].name, NULL, NULL);
        open_import(&m, &x);
        assert_int_equal(m.info.nv, expected[i].speeds);
        assert_int_equal(m.info.nc, expected[i].rows);
        assert_int_equal(m.assembly.freedoms, expected[i].freedoms);
        // drawn closed to rounding: nothing has to move
        assert_near(m.assembly.moved, 0, 1e-14);
        hn_model_close(&m);
        imported_close(&x);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_double_pendulum_has_the_accelerations_of_its_lagrangian),
        cmocka_unit_test(urdf_and_mjcf_of_one_mechanism_move_alike),
        cmocka_unit_test(a_four_bar_closed_by_connect_moves_as_our_own),
        cmocka_unit_test(spatial_loops_close_where_the_file_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
