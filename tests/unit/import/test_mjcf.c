// SPDX-License-Identifier: GPL-3.0-or-later
// What MJCF says and how it stands in the scene.
#include "base/clock.h"
#include "base/strbuf.h"
#include "support/near.h"

#include "support/imported.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

#define GEOM "<geom size='0.1' contype='0' conaffinity='0'/>"

static void angles_are_degrees_unless_the_compiler_says_radian(void **state) {
    (void)state;
    static const char inside[] =
        "<worldbody><body name='b' euler='0 0 0.5'><joint name='j' range='-0.5 1' stiffness='2' "
        "springref='0.25'/>" GEOM "</body></worldbody></mujoco>";
    char text[512];
    for (int radian = 0; radian < 2; radian++) {
        hn_imported x;
        (void)snprintf(text, sizeof text, "<mujoco>%s%s",
                       radian ? "<compiler angle='radian'/>" : "", inside);
        imported_open(&x, text, NULL);
        double unit = radian ? 1 : PI / 180;
        const hn_joint *j = &x.scene->joints[0];
        const hn_coordinate *c = &x.scene->coordinates[j->coordinate];
        assert_near(c->min, -0.5 * unit, 1e-16);
        assert_near(c->max, unit, 1e-16);
        assert_near(x.scene->loads[0].rest.value, 0.25 * unit, 1e-16);
        // the body is turned about z: its x axis, across the joint's, stands so in the world
        assert_near(j->parent_ref[0], cos(0.5 * unit), 1e-15);
        assert_near(j->parent_ref[1], sin(0.5 * unit), 1e-15);
        assert_near(j->child_ref[0], 1, 0);
        imported_close(&x);
    }
}

static void five_spellings_of_an_orientation_agree(void **state) {
    (void)state;
    // 120 degrees about (1, 1, 1): x to y, y to z, z to x
    static const char *const spellings[] = {"quat='0.5 0.5 0.5 0.5'", "axisangle='1 1 1 120'",
                                            "xyaxes='0 1 0 0 0 2'", "euler='90 90 0'",
                                            "euler='90 90 0'"};
    for (int k = 0; k < 5; k++) {
        char text[512];
        hn_imported x;
        (void)snprintf(text, sizeof text,
                       "<mujoco><compiler eulerseq='%s'/><worldbody><body name='b' %s>"
                       "<joint axis='0 0 1'/>" GEOM "</body></worldbody></mujoco>",
                       k == 4 ? "xzy" : "xyz", spellings[k]);
        imported_open(&x, text, NULL);
        const hn_joint *j = &x.scene->joints[0];
        if (k < 4) {
            assert_all_near(j->parent_axis, ((double[]){1, 0, 0}), 3, 2e-16);
            assert_all_near(j->parent_ref, ((double[]){0, 1, 0}), 3, 2e-16);
        } else {
            // x then z of the turned axes: R = Rx Rz, z goes to -y and x to z
            assert_all_near(j->parent_axis, ((double[]){0, -1, 0}), 3, 2e-16);
            assert_all_near(j->parent_ref, ((double[]){0, 0, 1}), 3, 2e-16);
        }
        imported_close(&x);
    }
}

static void capitals_of_eulerseq_turn_about_fixed_axes(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><compiler eulerseq='XYZ'/><worldbody><body name='b' euler='90 0 90'>"
                  "<joint axis='0 0 1'/>" GEOM "</body></worldbody></mujoco>",
                  NULL);
    // Rz Rx: z goes to -y, then to x
    assert_all_near(x.scene->joints[0].parent_axis, ((double[]){1, 0, 0}), 3, 2e-16);
    assert_all_near(x.scene->joints[0].parent_ref, ((double[]){0, 1, 0}), 3, 2e-16);
    imported_close(&x);
    imported_open(&x,
                  "<mujoco><worldbody><body name='b' zaxis='0 1 0'><joint axis='0 0 1'/>" GEOM
                  "</body></worldbody></mujoco>",
                  NULL);
    assert_all_near(x.scene->joints[0].parent_axis, ((double[]){0, 1, 0}), 3, 2e-16);
    imported_close(&x);
}

static void several_joints_of_a_body_act_in_their_order(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><worldbody><body name='b' pos='1 2 3'><joint name='a' type='slide' "
                  "axis='1 0 0'/><joint name='c' axis='0 1 0' pos='0 0 0.5'/><joint name='d' "
                  "axis='0 0 2'/>" GEOM "</body></worldbody></mujoco>",
                  NULL);
    assert_int_equal(x.scene->n_bodies, 3);
    assert_int_equal(hn_import_get_info(x.im).n_carriers, 2);
    const hn_joint *a = &x.scene->joints[imported_joint(&x, "a")],
                   *c = &x.scene->joints[imported_joint(&x, "c")],
                   *d = &x.scene->joints[imported_joint(&x, "d")];
    assert_int_equal(a->parent, HN_GROUND);
    assert_int_equal(c->parent, a->child);
    assert_int_equal(d->parent, c->child);
    assert_int_equal(d->child, imported_body(&x, "b"));
    assert_near(a->parent_at[0].value, 1, 0);
    assert_near(c->parent_at[2].value, 0.5, 0);
    assert_near(c->child_at[2].value, 0.5, 0);
    assert_near(d->parent_axis[2], 1, 0);
    assert_near(x.scene->bodies[c->child].mass.value, 0, 0);
    imported_close(&x);
}

static void coordinates_are_ref_in_the_pose_of_the_file(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><worldbody><body name='b' pos='0 0 1'><joint name='s' type='slide' "
                  "axis='0 0 1' ref='0.25'/><joint name='h' axis='0 1 0' ref='90'/>" GEOM
                  "</body></worldbody></mujoco>",
                  NULL);
    const hn_joint *s = &x.scene->joints[imported_joint(&x, "s")],
                   *h = &x.scene->joints[imported_joint(&x, "h")];
    assert_near(s->parent_at[2].value, 0.75, 0);
    assert_near(x.scene->coordinates[s->coordinate].q0, 0.25, 0);
    assert_near(x.scene->coordinates[h->coordinate].q0, PI / 2, 0);
    // at 90 degrees the child's reference has to stand where the parent's does after that turn
    // about y: x to -z
    assert_all_near(h->parent_ref, ((double[]){1, 0, 0}), 3, 0);
    assert_all_near(h->child_ref, ((double[]){0, 0, -1}), 3, 1e-15);
    imported_close(&x);
}

static void defaults_are_looked_up_from_the_nearest_class_outwards(void **state) {
    (void)state;
    hn_imported x;
    imported_open(
        &x,
        "<mujoco><default><joint damping='1' stiffness='7'/><geom contype='0' conaffinity='0' "
        "size='0.1'/><default class='soft'><joint damping='2'/><default class='softer'><joint "
        "stiffness='3'/></default></default></default><worldbody><body name='b' "
        "childclass='soft'><joint name='j'/><geom/><body name='c'><joint name='k' class='softer'/>"
        "<geom/><body name='d'><joint name='l' class='main' damping='5'/><geom/></body></body>"
        "</body></worldbody></mujoco>",
        NULL);
    static const double damping[] = {2, 2, 5}, stiffness[] = {7, 3, 7};
    assert_int_equal(x.scene->n_loads, 3);
    for (int k = 0; k < 3; k++) {
        assert_near(x.scene->loads[k].damping.value, damping[k], 0);
        assert_near(x.scene->loads[k].stiffness.value, stiffness[k], 0);
    }
    imported_close(&x);
}

static void frames_move_what_stands_in_them(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><worldbody><frame pos='1 0 0' euler='0 0 90'><body name='b' pos='1 0 0'>"
                  "<frame pos='0 0 1'><joint name='j' axis='1 0 0'/><geom size='0.1' mass='1'/>"
                  "</frame></body></frame></worldbody></mujoco>",
                  NULL);
    const hn_joint *j = &x.scene->joints[0];
    assert_near(j->parent_at[0].value, 1, 0);
    assert_near(j->parent_at[1].value, 1, 0);
    assert_near(j->parent_at[2].value, 1, 0);
    assert_all_near(j->parent_axis, ((double[]){0, 1, 0}), 3, 0);
    assert_near(x.scene->bodies[0].com[2].value, 1, 0);
    imported_close(&x);
}

static void connect_is_a_cut_ball_joint_at_the_common_place(void **state) {
    (void)state;
    hn_imported x;
    imported_open_file(&x, "four-bar.xml", NULL, NULL);
    const hn_joint *b = &x.scene->joints[imported_joint(&x, "B")];
    assert_int_equal(b->type, HN_JOINT_SPHERICAL);
    assert_true(b->cut);
    assert_near(b->parent_at[0].value, 2, 0);
    assert_near(b->child_at[0].value, 1.8, 1e-15);
    assert_near(b->child_at[2].value, 0, 1e-15);
    assert_near(x.scene->coordinates[0].q0, PI / 3, 1e-16);
    assert_false(x.scene->coordinates[0].q0_pinned);
    imported_close(&x);
}

static void weld_keeps_the_pose_of_the_file_or_the_one_given(void **state) {
    (void)state;
    static const char bodies[] = "<mujoco><worldbody><body name='b'><joint/>" GEOM
                                 "</body><body name='c' pos='1 0 0' euler='0 0 90'><joint/>" GEOM
                                 "</body></worldbody><equality><weld body1='b' body2='c' %s/>"
                                 "</equality></mujoco>";
    char text[512];
    hn_imported x;
    (void)snprintf(text, sizeof text, bodies, "");
    imported_open(&x, text, NULL);
    const hn_joint *j = &x.scene->joints[2];
    assert_int_equal(j->type, HN_JOINT_FIXED);
    assert_true(j->cut);
    assert_near(j->parent_at[0].value, 1, 0);
    assert_all_near(j->parent_ref, ((double[]){0, 1, 0}), 3, 0);
    imported_close(&x);
    (void)snprintf(text, sizeof text, bodies, "relpose='0 2 0 1 0 0 1'");
    imported_open(&x, text, NULL);
    j = &x.scene->joints[2];
    assert_near(j->parent_at[1].value, 2, 0);
    assert_all_near(j->parent_ref, ((double[]){0, 1, 0}), 3, 3e-16);
    imported_close(&x);
}

static void a_linear_coupling_is_a_gear_and_any_other_a_formula(void **state) {
    (void)state;
    static const char text_of[] =
        "<mujoco><compiler angle='radian'/><worldbody><body name='b'><joint name='y' "
        "ref='0.5'/>" GEOM "</body><body name='c'><joint name='x' ref='0.2'/>" GEOM
        "</body></worldbody><equality><joint joint1='y' joint2='x' "
        "polycoef='%s'/></equality></mujoco>";
    char text[512];
    hn_imported x;
    (void)snprintf(text, sizeof text, text_of, "0.1 3");
    imported_open(&x, text, NULL);
    // y - 0.5 = 0.1 + 3 (x - 0.2)
    assert_int_equal(x.scene->constraints[0].kind, HN_CONSTRAINT_GEAR);
    assert_near(x.scene->constraints[0].ratio.value, -3, 0);
    assert_near(x.scene->constraints[0].value.value, 0.0, 1e-15);
    imported_close(&x);
    (void)snprintf(text, sizeof text, text_of, "0 1 2");
    imported_open(&x, text, NULL);
    assert_int_equal(x.scene->constraints[0].kind, HN_CONSTRAINT_FORMULA);
    imported_close(&x);
}

static void drives_become_loads_whose_control_is_a_parameter(void **state) {
    (void)state;
    hn_imported x;
    imported_open_file(&x, "double-pendulum.xml", NULL, NULL);
    const hn_scene *s = x.scene;
    int u = hn_scene_find_param(s, "u_drive"), w = hn_scene_find_param(s, "u_servo");
    assert_true(u >= 0 && w >= 0);
    assert_near(s->params[u].value, 0.5, 0);
    assert_near(s->params[u].max, 2, 0);
    assert_near(s->params[w].value, 0.25, 0);
    const hn_load *follow = &s->loads[s->n_loads - 1];
    assert_int_equal(follow->kind, HN_LOAD_FOLLOW);
    assert_near(follow->stiffness.value, 40, 0);
    assert_near(follow->damping.value, 4, 0);
    assert_true(s->coordinates[0].actuated);
    // the first keyframe
    assert_near(s->coordinates[0].q0, 0.3, 0);
    assert_near(s->coordinates[1].v0, -2, 0);
    imported_close(&x);
    imported_open_file(&x, "double-pendulum.xml", NULL, "hanging");
    assert_near(x.scene->coordinates[0].q0, PI / 2, 0);
    imported_close(&x);
    imported_open_file(&x, "double-pendulum.xml", NULL, "qpos0");
    assert_near(x.scene->coordinates[0].q0, 0, 0);
    imported_close(&x);
}

static void a_free_body_starts_where_the_file_places_it(void **state) {
    (void)state;
    hn_imported x;
    imported_open(&x,
                  "<mujoco><worldbody><body name='b' pos='1 2 3' axisangle='0 0 1 90'><freejoint/>"
                  "<geom size='0.1'/></body></worldbody></mujoco>",
                  NULL);
    static const double q0[] = {1, 2, 3, 0, 0, 1.5707963267948966};
    const hn_joint *j = &x.scene->joints[0];
    assert_int_equal(j->type, HN_JOINT_FREE);
    for (int k = 0; k < 6; k++) {
        assert_near(x.scene->coordinates[j->coordinate + k].q0, q0[k], 1e-15);
    }
    imported_close(&x);
}

/// Returns what the file tells of geoms that can touch one another; NULL: nothing.
static const hn_import_note *contact_note(hn_imported *x, const char *bodies, const char *rest) {
    char text[1200];
    snprintf(text, sizeof text, "<mujoco>%s<worldbody>%s</worldbody></mujoco>", rest, bodies);
    imported_open(x, text, NULL);
    return imported_note(x, "/geom");
}

static void only_geoms_that_mujoco_lets_touch_are_told(void **state) {
    (void)state;
#define HINGE "<joint axis='0 1 0'/>"
#define BAR "<geom type='capsule' fromto='0 0 0 0.5 0 0' size='0.02'/>"
#define CHILD "<body name='b' pos='0.5 0 0'>" HINGE BAR "</body>"
    static const struct {
        const char *bodies, *rest;
        bool told;
    } cases[] = {
        // a body and its parent do not touch, its grandparent can be touched
        {"<body name='a'>" HINGE BAR CHILD "</body>", "", false},
        {"<body name='a'>" HINGE BAR CHILD "</body>",
         "<option><flag filterparent='disable'/></option>", true},
        {"<body name='a'>" HINGE BAR "<body name='m'>" HINGE BAR CHILD "</body></body>", "", true},
        // a parent that stands still can be touched, fixed parts of one body cannot
        {BAR "<body name='a'>" HINGE BAR "</body>", "", true},
        {"<body name='a'>" HINGE BAR "<body name='m'>" BAR "</body></body>", "", false},
        {"<body name='a'>" HINGE BAR BAR "</body>", "", false},
        // two bodies of the ground, and what takes such a pair out
        {"<body name='a'>" HINGE BAR "</body>" CHILD, "", true},
        {"<body name='a'>" HINGE BAR "</body>" CHILD,
         "<contact><exclude body1='b' body2='a'/></contact>", false},
        {"<body name='a'>" HINGE BAR "</body>" CHILD, "<option><flag contact='disable'/></option>",
         false},
        {"<body name='a'>" HINGE BAR "</body>" CHILD,
         "<default><geom contype='2' conaffinity='1'/></default>", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_imported x;
        const hn_import_note *note = contact_note(&x, cases[i].bodies, cases[i].rest);
        print_message("case %zu\n", i);
        assert_int_equal(note != NULL, cases[i].told);
        imported_close(&x);
    }
}

/// 1,900 bodies, fixed to one another in long chains, whose geoms touch nothing: each pair of them
/// is looked at without a walk down its chain, which took minutes.
static void many_fixed_bodies_are_read_soon(void **state) {
    (void)state;
    enum { CHAINS = 20, LONG = 95 };
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_add(&text, "<mujoco><worldbody>");
    for (int i = 0; i < CHAINS * LONG; i++) {
        hn_strbuf_add(&text, "<body>");
        hn_strbuf_add(&text, i % LONG == 0 ? HINGE : "");
        hn_strbuf_add(&text, "<geom type='sphere' size='0.01' contype='1' conaffinity='0'/>");
        for (int k = 0; i % LONG == LONG - 1 && k < LONG; k++) {
            hn_strbuf_add(&text, "</body>");
        }
    }
    hn_strbuf_add(&text, "</worldbody></mujoco>");

    // about a tenth of a second; the bound is far above what a busy machine needs
    hn_imported x;
    const double began = hn_clock_thread();
    imported_open(&x, hn_strbuf_text(&text), NULL);
    assert_true(hn_clock_thread() - began < 20);
    assert_int_equal(x.scene->n_bodies, CHAINS * LONG);
    assert_null(imported_note(&x, "/geom"));
    imported_close(&x);
    hn_strbuf_reset(&text);
}

static void everything_that_is_not_taken_is_named_with_its_line(void **state) {
    (void)state;
    hn_imported x;
    imported_open_file(&x, "leg.xml", NULL, NULL);
    static const struct {
        const char *where;
        hn_import_outcome outcome;
        int line;
    } expected[] = {{"/@armature", HN_IMPORT_REFUSED, 21},
                    {"/connect/@solref", HN_IMPORT_APPROXIMATED, 37},
                    {"/muscle", HN_IMPORT_REFUSED, 43},
                    {"/exclude", HN_IMPORT_REFUSED, 45},
                    {"/jointpos", HN_IMPORT_IGNORED, 46}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const hn_import_note *note = imported_note(&x, expected[i].where);
        assert_non_null(note);
        assert_int_equal(note->outcome, expected[i].outcome);
        assert_int_equal(note->line, expected[i].line);
    }
    assert_int_equal(hn_import_note_count(x.im), 5);
    imported_close(&x);
}

/// Any attribute or element put anywhere is either used or named.
static void an_unknown_attribute_or_element_anywhere_is_named(void **state) {
    (void)state;
    char *text = imported_text("leg.xml");
    int n = 0;
    for (char *at = strchr(text, '<'); at; at = strchr(at + 1, '<')) {
        size_t name = strcspn(at + 1, " />!");
        // elements of sections that are not read are named whole
        if (at[1] == '/' || at[1] == '!' || strncmp(at + 1, "muscle", 6) == 0 ||
            strncmp(at + 1, "exclude", 7) == 0 || strncmp(at + 1, "jointpos", 8) == 0 ||
            strncmp(at + 1, "contact", 7) == 0 || strncmp(at + 1, "sensor", 6) == 0) {
            continue;
        }
        size_t head = (size_t)(at - text) + 1 + name, room = strlen(text) + 64;
        char *changed = malloc(room);
        assert_non_null(changed);
        (void)snprintf(changed, room, "%.*s unheard='of'%s", (int)head, text, text + head);
        hn_imported x;
        imported_open(&x, changed, NULL);
        assert_non_null(imported_note(&x, "/@unheard"));
        imported_close(&x);
        free(changed);
        n++;
    }
    assert_true(n > 30);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_are_degrees_unless_the_compiler_says_radian),
        cmocka_unit_test(five_spellings_of_an_orientation_agree),
        cmocka_unit_test(capitals_of_eulerseq_turn_about_fixed_axes),
        cmocka_unit_test(several_joints_of_a_body_act_in_their_order),
        cmocka_unit_test(coordinates_are_ref_in_the_pose_of_the_file),
        cmocka_unit_test(defaults_are_looked_up_from_the_nearest_class_outwards),
        cmocka_unit_test(frames_move_what_stands_in_them),
        cmocka_unit_test(connect_is_a_cut_ball_joint_at_the_common_place),
        cmocka_unit_test(weld_keeps_the_pose_of_the_file_or_the_one_given),
        cmocka_unit_test(a_linear_coupling_is_a_gear_and_any_other_a_formula),
        cmocka_unit_test(drives_become_loads_whose_control_is_a_parameter),
        cmocka_unit_test(a_free_body_starts_where_the_file_places_it),
        cmocka_unit_test(only_geoms_that_mujoco_lets_touch_are_told),
        cmocka_unit_test(many_fixed_bodies_are_read_soon),
        cmocka_unit_test(everything_that_is_not_taken_is_named_with_its_line),
        cmocka_unit_test(an_unknown_attribute_or_element_anywhere_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
