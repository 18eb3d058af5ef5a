// SPDX-License-Identifier: GPL-3.0-or-later
// The loader's reading of joints with several coordinates, of constraints beside joints, and of
// actuators.
#include "scene/scene.h"

#include "support/near.h"
#include "support/scene_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define HEAD "{\"holonom\":1, \"name\":\"x\", "
#define BODIES                                                                          \
    "\"bodies\":[{\"name\":\"a\",\"mass\":2,\"inertia\":{\"xx\":3,\"yy\":4,\"zz\":5}}," \
    "{\"name\":\"b\",\"mass\":1}], "
#define SIDES(p, c) "\"parent\":{\"body\":\"" p "\"},\"child\":{\"body\":\"" c "\"}"
#define ON_GROUND "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"a\"}"
#define TWO_REVOLUTES                                           \
    "\"joints\":[{\"name\":\"A\",\"type\":\"revolute\"," SIDES( \
        "ground",                                               \
        "a") "},"                                               \
             "{\"name\":\"B\",\"type\":\"revolute\"," SIDES("a", "b") ",\"coordinate\":\"th\"}], "

static void every_type_has_its_freedoms_names_and_units(void **state) {
    static const struct {
        const char *type, *extra, *names[6];
        hn_unit_kind kind[6];
        int turn[6], n;
    } rows[] = {
        {"revolute", "", {"J"}, {HN_ANGLE}, {-1}, 1},
        {"prismatic", ",\"axis\":[1,0,0]", {"J"}, {HN_LENGTH}, {-1}, 1},
        {"cylindrical",
         ",\"axis\":[1,0,0]",
         {"J_angle", "J_way"},
         {HN_ANGLE, HN_LENGTH},
         {-1, -1},
         2},
        {"universal",
         ",\"axis\":[1,0,0],\"axis2\":[0,1,0]",
         {"J_1", "J_2"},
         {HN_ANGLE, HN_ANGLE},
         {-1, -1},
         2},
        {"spherical", "", {"J_rx", "J_ry", "J_rz"}, {HN_ANGLE, HN_ANGLE, HN_ANGLE}, {0, 1, 2}, 3},
        {"planar",
         "",
         {"J_x", "J_y", "J_angle"},
         {HN_LENGTH, HN_LENGTH, HN_ANGLE},
         {-1, -1, -1},
         3},
        {"fixed", "", {NULL}, {HN_OTHER}, {-1}, 0},
        {"free",
         "",
         {"J_x", "J_y", "J_z", "J_rx", "J_ry", "J_rz"},
         {HN_LENGTH, HN_LENGTH, HN_LENGTH, HN_ANGLE, HN_ANGLE, HN_ANGLE},
         {-1, -1, -1, 0, 1, 2},
         6},
    };
    (void)state;
    assert_int_equal(sizeof rows / sizeof *rows, HN_JOINT_TYPE_COUNT);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[1024];
        snprintf(text, sizeof text,
                 HEAD BODIES "\"joints\":[{\"name\":\"R\",\"type\":\"revolute\"," SIDES(
                     "a", "b") "},{\"name\":\"J\",\"type\":\"%s\"%s," ON_GROUND "}]}",
                 rows[k].type, rows[k].extra);
        hn_scene *s = hn_test_scene(text);
        const hn_joint *j = &s->joints[1];
        assert_string_equal(hn_joint_type_name(j->type), rows[k].type);
        assert_int_equal(j->n_coordinates, rows[k].n);
        assert_int_equal(j->coordinate, rows[k].n > 0 ? 1 : -1);
        assert_int_equal(s->n_coordinates, 1 + rows[k].n);
        for (int i = 0; i < rows[k].n; i++) {
            const hn_coordinate *c = &s->coordinates[1 + i];
            char rate[32];
            snprintf(rate, sizeof rate, "d_%s", rows[k].names[i]);
            assert_string_equal(c->name, rows[k].names[i]);
            assert_string_equal(c->rate, rate);
            assert_int_equal(c->kind, rows[k].kind[i]);
            assert_int_equal(c->turn, rows[k].turn[i]);
            assert_int_equal(c->part, i);
            assert_int_equal(c->joint, 1);
        }
        hn_scene_free(s);
    }
}

static void names_actuators_and_limits_of_a_joint_are_kept(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD "\"parameters\":{\"far\":3}," BODIES
             "\"joints\":[{\"name\":\"P\",\"type\":\"planar\"," ON_GROUND
             ",\"coordinates\":[\"x\",\"y\",\"phi\"],\"rates\":[\"vx\",\"vy\",\"om\"],"
             "\"actuated\":[\"phi\",\"x\"],\"limits\":{\"x\":[\"-far\",\"far\"],\"phi\":[null,2]}},"
             "{\"name\":\"R\",\"type\":\"revolute\"," SIDES(
                 "a", "b") ",\"actuated\":true,\"limits\":[-1,1]}]}");
    (void)state;
    const hn_coordinate *c = s->coordinates;
    assert_int_equal(hn_scene_find_coordinate(s, "phi"), 2);
    assert_string_equal(c[2].rate, "om");
    assert_true(c[0].actuated && !c[1].actuated && c[2].actuated && c[3].actuated);
    assert_near(c[0].min, -3, 0);
    assert_near(c[0].max, 3, 0);
    assert_true(c[1].min == -HUGE_VAL && c[1].max == HUGE_VAL);
    assert_true(c[2].min == -HUGE_VAL && c[2].max == 2);
    assert_true(c[3].min == -1 && c[3].max == 1);
    hn_scene_free(s);
}

static void a_universal_joint_keeps_its_second_axis_as_reference(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD BODIES
        "\"joints\":[{\"name\":\"U\",\"type\":\"universal\",\"axis\":[2,0,0],"
        "\"axis2\":[0,0,-3],\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"a\","
        "\"axis\":[0,1,0],\"axis2\":[1,0,0]}},{\"name\":\"R\",\"type\":\"fixed\"," SIDES(
            "a", "b") "}]}");
    (void)state;
    const hn_joint *j = &s->joints[0];
    static const double expected[4][3] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    const double *found[4] = {j->parent_axis, j->parent_ref, j->child_axis, j->child_ref};
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 3; i++) {
            assert_near(found[k][i], expected[k][i], 0);
        }
    }
    hn_scene_free(s);
}

static void every_kind_of_constraint_is_kept(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD
        "\"parameters\":{\"w\":3,\"l\":2}," BODIES TWO_REVOLUTES "\"constraints\":["
        "{\"distance\":{\"from\":{\"body\":\"b\",\"at\":[1,0]},\"to\":[3,0],\"length\":\"l\"}},"
        "{\"name\":\"rail\",\"line\":{\"point\":{\"body\":\"b\",\"at\":[1,0]},\"through\":[0,1],"
        "\"direction\":[0,5]}},"
        "{\"plane\":{\"point\":{\"body\":\"b\",\"at\":[1,0]},\"through\":[0,0],"
        "\"direction\":[0,0,2],\"offset\":0.5}},"
        "{\"gear\":{\"coordinates\":[\"A\",\"th\"],\"ratio\":\"-l\",\"phase\":0.25}},"
        "{\"rolling\":{\"centre\":{\"body\":\"a\",\"at\":[0,0]},\"through\":[0,-1],"
        "\"direction\":[1,0],\"up\":[0,2],\"radius\":1}},"
        "{\"formula\":\"sin(A) - th^2\"},"
        "{\"motion\":{\"coordinate\":\"th\",\"value\":\"w*t\"}},"
        "{\"for\":{\"i\":[1,2]},\"name\":\"hold{i}\",\"motion\":{\"joint\":\"A\",\"value\":-0.5}}"
        "]}");
    (void)state;
    const hn_constraint *c = s->constraints;
    assert_int_equal(s->n_constraints, 9);
    assert_string_equal(c[0].name, "distance 1");
    assert_near(c[0].value.value, 2, 0);
    assert_int_equal(s->points[c[0].q].body, HN_GROUND);
    assert_int_equal(c[0].p, c[1].p); // the same place is the same point
    assert_string_equal(c[1].name, "rail");
    assert_true(c[1].direction[0] == 0 && c[1].direction[1] == 1 && c[1].direction[2] == 0);
    assert_true(c[2].direction[2] == 1 && c[2].value.value == 0.5);
    assert_int_equal(c[3].coordinate[0], 0);
    assert_int_equal(c[3].coordinate[1], 1);
    assert_true(c[3].ratio.value == -2 && c[3].value.value == 0.25 && c[3].p == -1);
    assert_true(c[4].up[1] == 1 && c[4].value.value == 1);
    assert_int_equal(c[5].kind, HN_CONSTRAINT_FORMULA);
    assert_true(c[5].value.varies);
    assert_string_equal(c[6].value.formula, "th - (w*t)");
    assert_string_equal(c[8].name, "hold2");
    assert_string_equal(c[8].value.formula, "A - (-0.5)");
    hn_scene_free(s);
}

static void moments_followers_and_tables_are_kept(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD "\"parameters\":{\"k\":100}," BODIES TWO_REVOLUTES "\"loads\":["
             "{\"moment\":{\"body\":\"b\",\"value\":[0,\"d_th\",\"k\"]}},"
             "{\"follow\":{\"joint\":\"A\",\"stiffness\":\"k\",\"damping\":2,"
             "\"target\":\"sin(t)\",\"limit\":7}},"
             "{\"table\":{\"coordinate\":\"th\",\"t\":[0,1,\"2*1.5\"],\"value\":[1,2,\"k\"],"
             "\"steps\":true}}]}");
    (void)state;
    const hn_load *l = s->loads;
    assert_int_equal(s->n_loads, 3);
    assert_int_equal(l[0].kind, HN_LOAD_MOMENT);
    assert_int_equal(s->points[l[0].p].body, 1);
    assert_true(l[0].value[1].varies && l[0].value[2].value == 100);
    assert_int_equal(l[1].kind, HN_LOAD_FOLLOW);
    assert_int_equal(l[1].coordinate, 0);
    assert_true(l[1].stiffness.value == 100 && l[1].damping.value == 2 && l[1].value[0].varies);
    assert_true(l[1].value[1].value == 7);
    assert_int_equal(l[2].kind, HN_LOAD_TABLE);
    assert_int_equal(l[2].table.n, 3);
    assert_true(l[2].table.t[2] == 3 && l[2].table.value[2] == 100 && l[2].table.steps);
    hn_scene_free(s);
}

static void rates_of_a_spherical_joint_may_be_used_where_its_rotation_vector_may_not(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD BODIES
        "\"joints\":[{\"name\":\"S\",\"type\":\"spherical\"," ON_GROUND "},"
        "{\"name\":\"R\",\"type\":\"revolute\"," SIDES(
            "a", "b") "}],"
                      "\"loads\":[{\"torque\":{\"coordinate\":\"S_rz\",\"value\":\"-2*d_S_rz\"}},"
                      "{\"joint_spring\":{\"coordinate\":\"S_rx\",\"damping\":3}}],"
                      "\"start\":{\"positions\":{\"S_rx\":0.5},\"mode\":\"+-+\"}}");
    (void)state;
    assert_int_equal(s->n_loads, 2);
    assert_near(s->coordinates[0].q0, 0.5, 0);
    assert_string_equal(s->mode, "+-+");
    hn_scene_free(s);
}

static void the_hash_sees_joints_constraints_and_mode(void **state) {
    static const char *const ends[] = {
        "}", ",\"constraints\":[{\"formula\":\"A - t\"}]}",
        ",\"constraints\":[{\"formula\":\"A - 2*t\"}]}", ",\"start\":{\"mode\":\"open\"}}",
        ",\"loads\":[{\"table\":{\"joint\":\"A\",\"t\":[0],\"value\":[1]}}]}"};
    uint64_t hash[5];
    (void)state;
    for (int k = 0; k < 5; k++) {
        char text[1024];
        snprintf(text, sizeof text,
                 HEAD BODIES "\"joints\":[{\"name\":\"A\",\"type\":\"revolute\"," ON_GROUND
                             "},{\"name\":\"B\",\"type\":\"fixed\"," SIDES("a", "b") "}]%s",
                 ends[k]);
        hn_scene *s = hn_test_scene(text);
        hash[k] = s->hash;
        hn_scene_free(s);
        for (int i = 0; i < k; i++) {
            assert_true(hash[i] != hash[k]);
        }
    }
}

// edges of the block with m = 2, moments 3, 4, 5: a^2 = 6 (yy + zz - xx) / m = 18, b^2 = 12, c^2 =
// 6
static void a_free_body_is_drawn_with_the_extents_of_its_inertia(void **state) {
    hn_scene *s = hn_test_scene(HEAD BODIES
                                "\"joints\":[{\"name\":\"F\",\"type\":\"free\"," ON_GROUND
                                "},{\"name\":\"G\",\"type\":\"free\"," SIDES("ground", "b") "}]}");
    static const double expected[3] = {18, 12, 6};
    (void)state;
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_BAR), 3);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_PIVOT), 1); // the point mass
    for (int i = 0; i < 3; i++) {
        const hn_quantity *p = s->points[s->shapes[i].p].at, *q = s->points[s->shapes[i].q].at;
        double edge = q[i].value - p[i].value;
        assert_near(edge * edge, expected[i], 1e-13); // rounding of a root and its square
        assert_int_equal(s->shapes[i].body, 0);
    }
    hn_scene_free(s);
}

static void constraints_are_drawn_as_rods_guides_and_wheels(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD BODIES
        "\"joints\":[{\"name\":\"A\",\"type\":\"planar\"," ON_GROUND "},"
        "{\"name\":\"B\",\"type\":\"free\"," SIDES(
            "ground",
            "b") "}],"
                 "\"constraints\":["
                 "{\"distance\":{\"from\":{\"body\":\"b\",\"at\":[1,0]},\"to\":[3,0],"
                 "\"length\":2}},"
                 "{\"plane\":{\"point\":{\"body\":\"b\",\"at\":[1,0]},\"through\":[0,0],"
                 "\"direction\":[0,2,0],\"offset\":0.5}},"
                 "{\"rolling\":{\"centre\":{\"body\":\"a\",\"at\":[0,0]},\"through\":[0,-1],"
                 "\"direction\":[1,0],\"up\":[0,2],\"radius\":0.75}}]}");
    (void)state;
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_GUIDE), 1);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_POLYGON), 1);
    int roads = 0;
    for (int i = 0; i < s->n_shapes; i++) {
        const hn_shape *shape = &s->shapes[i];
        if (shape->kind == HN_SHAPE_POLYGON) {
            for (int k = 0; k < shape->n; k++) {
                const hn_quantity *at = s->points[shape->p + k].at;
                assert_near(hypot(at[0].value, at[1].value), 0.75, 1e-15);
            }
        }
        // the top of the road is the line y = -1
        if (shape->kind == HN_SHAPE_BAR && shape->body == HN_GROUND &&
            s->points[shape->p].body == HN_GROUND && shape->width == 0.75 / 20) {
            roads++;
            assert_near(s->points[shape->q].at[1].value + shape->width / 2, -1, 1e-15);
        }
        // the trace of the plane y = 0.5 in the drawing
        if (shape->kind == HN_SHAPE_GUIDE && s->points[shape->p].at[1].value == 0.5) {
            assert_near(s->points[shape->q].at[1].value, 0.5, 0);
            assert_near(fabs(s->points[shape->q].at[0].value), 1, 0);
        }
    }
    assert_int_equal(roads, 1);
    hn_scene_free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_has_its_freedoms_names_and_units),
        cmocka_unit_test(names_actuators_and_limits_of_a_joint_are_kept),
        cmocka_unit_test(a_universal_joint_keeps_its_second_axis_as_reference),
        cmocka_unit_test(every_kind_of_constraint_is_kept),
        cmocka_unit_test(moments_followers_and_tables_are_kept),
        cmocka_unit_test(rates_of_a_spherical_joint_may_be_used_where_its_rotation_vector_may_not),
        cmocka_unit_test(the_hash_sees_joints_constraints_and_mode),
        cmocka_unit_test(a_free_body_is_drawn_with_the_extents_of_its_inertia),
        cmocka_unit_test(constraints_are_drawn_as_rods_guides_and_wheels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
