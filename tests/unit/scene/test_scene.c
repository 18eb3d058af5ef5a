// SPDX-License-Identifier: GPL-3.0-or-later
// Sound scenes as the loader reads them: the shipped ones, and small ones for each rule of the
// format.
#include "expr/construct.h"
#include "expr/parse.h"
#include "scene/scene.h"

#include "support/near.h"
#include "support/scene_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LESSON "lessons/01-closed-loops/scenes/"
#define HEAD "{\"holonom\":1, \"name\":\"x\", "
#define ONE_BODY "\"bodies\":[{\"name\":\"b\",\"mass\":1}], "
#define ONE_JOINT                                                                         \
    "\"joints\":[{\"name\":\"j\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"}," \
    "\"child\":{\"body\":\"b\"}}]"

static hn_scene *load_set(const char *path, const hn_setting *set, int n) {
    hn_scene *scene = NULL;
    hn_diags diags = {0};
    if (hn_scene_load_file(path, set, n, &scene, &diags) != HN_OK) {
        fail_msg("%s: %s: %s (%s)", path, diags.item[0].pointer, diags.item[0].message,
                 diags.item[0].hint);
    }
    return scene;
}

// ---- the shipped scenes ----

static void scenes_load_with_their_sizes(void **state) {
    static const struct {
        const char *path;
        int bodies, joints, coordinates, constraints, actuated;
    } rows[] = {
        {LESSON "four-bar.json", 3, 4, 4, 0, 1},
        {LESSON "fb0.json", 3, 4, 4, 0, 1},
        {LESSON "fb0-lagrangian.json", 0, 0, 3, 2, 1},
        {LESSON "four-angles-as-printed.json", 0, 0, 4, 2, 1},
        {LESSON "slider-crank.json", 3, 4, 4, 0, 1},
        {LESSON "five-bar.json", 4, 5, 5, 0, 2},
        {LESSON "double-pendulum.json", 2, 2, 2, 0, 0},
        {LESSON "n-four-bar.json", 5, 7, 7, 0, 0},
        {LESSON "pendulum.json", 1, 1, 1, 0, 0},
        {"tests/scenes/fb0-tilted.json", 3, 4, 4, 0, 1},
        {"tests/scenes/fb0-redundant.json", 3, 5, 5, 0, 1},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hn_scene *s = load_set(rows[i].path, NULL, 0);
        int actuated = 0;
        for (int k = 0; k < s->n_coordinates; k++) {
            actuated += s->coordinates[k].actuated;
        }
        assert_int_equal(s->n_bodies, rows[i].bodies);
        assert_int_equal(s->n_joints, rows[i].joints);
        assert_int_equal(s->n_coordinates, rows[i].coordinates);
        assert_int_equal(s->lagrangian.n_constraints, rows[i].constraints);
        assert_int_equal(actuated, rows[i].actuated);
        assert_int_equal(s->is_lagrangian, rows[i].bodies == 0);
        assert_true(s->n_shapes > 0 && s->n_methods > 0 && s->duration > 0 && s->step > 0);
        assert_true(strlen(s->title) > 5 && strlen(s->about) > 80);
        for (int k = 0; k < s->n_params; k++) {
            assert_true(s->params[k].about[0] && s->params[k].min < s->params[k].max &&
                        isfinite(s->params[k].min + s->params[k].max));
            assert_true(s->params[k].value == s->params[k].initial);
        }
        hn_scene_free(s);
    }
}

static void fb0_has_the_numbers_of_the_reference(void **state) {
    hn_scene *s = load_set(LESSON "fb0.json", NULL, 0);
    (void)state;
    assert_string_equal(s->id, "fb0");
    const hn_body *rocker = &s->bodies[hn_scene_find_body(s, "rocker")];
    assert_near(rocker->mass.value, 1.8, 0);
    assert_near(rocker->com[0].value, 0.9, 1e-15);
    assert_near(rocker->inertia[2].value, 1.8 * 1.8 * 1.8 / 12, 1e-15);
    // zz alone: a thin rod along x
    assert_near(rocker->inertia[1].value, rocker->inertia[2].value, 0);
    assert_near(rocker->inertia[0].value, 0, 0);
    assert_string_equal(rocker->inertia[2].formula, "m3*l3^2/12");
    assert_string_equal(rocker->inertia[2].pointer, "/bodies/2/inertia/zz");
    assert_near(s->gravity[1].value, -9.81, 0);
    const hn_coordinate *th1 = &s->coordinates[hn_scene_find_coordinate(s, "th1")],
                        *a2 = &s->coordinates[hn_scene_find_coordinate(s, "a2")];
    assert_true(th1->q0_pinned && th1->v0_pinned && a2->q0_given && !a2->q0_pinned &&
                !a2->v0_given);
    assert_near(th1->q0, 1, 0);
    assert_near(th1->v0, 2, 0);
    assert_string_equal(th1->v0_pointer, "/start/rates/th1");
    const hn_joint *b = &s->joints[3];
    assert_int_equal(b->cut, 1);
    assert_int_equal(b->parent, hn_scene_find_body(s, "coupler"));
    assert_int_equal(b->child, hn_scene_find_body(s, "rocker"));
    hn_scene_free(s);
}

static void the_ladder_grows_with_its_parameter(void **state) {
    (void)state;
    for (int n = 1; n <= 200; n = n * 3 + 1) {
        hn_setting set = {"N", n};
        hn_scene *s = load_set(LESSON "n-four-bar.json", &set, 1);
        assert_int_equal(s->n_bodies, 2 * n + 1);
        assert_int_equal(s->n_joints, 3 * n + 1);
        assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_BAR), 2 * n + 1);
        assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_GROUND), n + 1);
        const hn_param *p = &s->params[hn_scene_find_param(s, "N")];
        assert_true(p->structural && p->integer && p->value == n && p->initial == 2);
        assert_false(s->params[hn_scene_find_param(s, "L")].structural);
        // the last cut joint closes the last loop at the tip of the last vertical
        const hn_joint *last = &s->joints[3 * n];
        char name[32];
        snprintf(name, sizeof name, "vertical %d", n);
        assert_int_equal(last->child, hn_scene_find_body(s, name));
        assert_int_equal(last->cut, 1);
        snprintf(name, sizeof name, "th%d", n);
        assert_near(s->coordinates[hn_scene_find_coordinate(s, name)].q0, acos(-1) / 2, 1e-15);
        assert_near(s->joints[n].parent_at[0].value, n, 0);
        char text[32];
        snprintf(text, sizeof text, "%d*L", n);
        assert_string_equal(s->joints[n].parent_at[0].formula, text);
        hn_scene_free(s);
    }
}

static void the_tilted_four_bar_has_unit_axes_and_the_inertia_of_thin_rods(void **state) {
    hn_scene *s = load_set("tests/scenes/fb0-tilted.json", NULL, 0);
    (void)state;
    for (int k = 0; k < s->n_joints; k++) {
        const hn_joint *j = &s->joints[k];
        double zz = 0, xx = 0, zx = 0;
        for (int i = 0; i < 3; i++) {
            zz += j->parent_axis[i] * j->parent_axis[i];
            xx += j->child_ref[i] * j->child_ref[i];
            zx += j->child_axis[i] * j->child_ref[i];
        }
        assert_near(zz, 1, 1e-15);
        assert_near(xx, 1, 1e-15);
        assert_near(zx, 0, 1e-16);
    }
    const hn_quantity *I = s->bodies[1].inertia;
    // the trace is that of fb0
    assert_near(I[0].value + I[1].value + I[2].value, 2 * 2.0 * 4 / 12, 1e-14);
    hn_scene_free(s);
}

static void the_hash_is_of_what_moves_not_of_words_or_white_space(void **state) {
    (void)state;
    hn_setting same = {"l1", 1}, other = {"l1", 1.25};
    hn_scene *a = load_set(LESSON "fb0.json", NULL, 0), *b = load_set(LESSON "fb0.json", &same, 1),
             *c = load_set(LESSON "fb0.json", &other, 1);
    assert_true(a->hash == b->hash);
    assert_true(a->hash != c->hash);
    assert_near(c->bodies[0].com[0].value, 0.625, 0);
    assert_near(c->params[0].initial, 1, 0);
    hn_scene *d = hn_test_scene(HEAD ONE_BODY ONE_JOINT "}"),
             *e = hn_test_scene(HEAD "\n\t" ONE_BODY "\n" ONE_JOINT "\n}\n");
    hn_scene *f = hn_test_scene(HEAD "\"title\":\"y\", \"duration\": 3, " ONE_BODY ONE_JOINT "}");
    hn_scene *g = hn_test_scene(HEAD ONE_BODY ONE_JOINT ", \"gravity\": [0, -1, 0]}");
    assert_true(d->hash == e->hash);
    assert_true(d->hash == f->hash);
    assert_true(d->hash != g->hash);
    hn_scene *all[] = {a, b, c, d, e, f, g};
    for (int i = 0; i < 7; i++) {
        hn_scene_free(all[i]);
    }
}

// ---- the formulas of the Lagrangian scenes against the reference ----

/// A value for each name of a formula.
typedef struct named_values {
    int n;
    const char *name[24];
    double value[24];
} named_values;

static int find_value(void *user, const char *name, hn_ex *out) {
    const named_values *v = user;
    for (int i = 0; i < v->n; i++) {
        if (strcmp(v->name[i], name) == 0) {
            *out = hn_num(v->value[i]);
            return 1;
        }
    }
    return 0;
}

static double formula_value(const named_values *v, const char *formula) {
    hn_graph *g = hn_graph_create();
    hn_parse_opts opts = {.lookup = find_value, .user = (void *)v};
    hn_ex e;
    double value = hn_poison();
    assert_int_equal(hn_parse(g, formula, &opts, &e, NULL), HN_OK);
    assert_true(hn_is_number(e, &value));
    hn_graph_free(g);
    return value;
}

/// Parameters of the scene and a state, the rates of links 2 and 3 from the two velocity equations
/// of the loop.
static named_values fb0_state(const hn_scene *s, double th1, double th2, double th3, double w1) {
    const double l1 = 1, l2 = 2, l3 = 1.8;
    double a = -l2 * sin(th2), b = l3 * sin(th3), c = l2 * cos(th2), d = -l3 * cos(th3);
    double r1 = l1 * w1 * sin(th1), r2 = -l1 * w1 * cos(th1), det = a * d - b * c;
    const char *names[] = {"th1", "th2", "th3", "th4", "w1", "w2", "w3", "w4"};
    double values[] = {th1, th2, th3, 0, w1, (r1 * d - b * r2) / det, (a * r2 - c * r1) / det, 0};
    named_values v = {.n = 0};
    for (int i = 0; i < s->n_params; i++) {
        v.name[v.n] = s->params[i].name;
        v.value[v.n++] = s->params[i].value;
    }
    for (int i = 0; i < 8; i++) {
        v.name[v.n] = names[i];
        v.value[v.n++] = values[i];
    }
    return v;
}

static void energy_and_loop_of_fb0_are_those_of_its_reference_motion(void **state) {
    // th1, th2, th3, w1 at t = 0, 1, 2 s: th1 by quadrature of dt = dth1 / w1(th1), where w1
    // follows from the energy and the other angles from the triangle of coupler, rocker and
    // diagonal
    static const double motion[3][4] = {
        {1, 0.498324904142577, 1.516841745037813, 2},
        {2.726775244353718, 0.4341207943944537, 2.3783762332849223, 4.168076162534862},
        {7.4113667986921135, 0.4646903788895538, 1.5617825877135394, 1.5714906085068785},
    };
    // held at th4 = 0, the four angles are the same mechanism: link 4 lies still
    static const char *const files[] = {LESSON "fb0-lagrangian.json",
                                        LESSON "four-angles-as-printed.json"};
    (void)state;
    for (int f = 0; f < 2; f++) {
        hn_scene *s = load_set(files[f], NULL, 0);
        for (int i = 0; i < 3; i++) {
            named_values v = fb0_state(s, motion[i][0], motion[i][1], motion[i][2], motion[i][3]);
            double energy = formula_value(&v, s->lagrangian.kinetic.formula) +
                            formula_value(&v, s->lagrangian.potential.formula);
            assert_near(energy, 49.34675722838445, 2e-13);
            for (int k = 0; k < 2; k++) {
                assert_near(formula_value(&v, s->lagrangian.constraints[k].formula), 0, 2e-14);
            }
        }
        hn_scene_free(s);
    }
}

// ---- rules of the format ----

static void parameters_may_be_formulas_of_each_other_in_any_order(void **state) {
    static const char text[] =
        HEAD "\"parameters\":{\"c\":\"2*b + pi\", \"b\":{\"value\":\"a^2\"}, \"a\":3}, " ONE_BODY
            ONE_JOINT "}";
    hn_setting set = {"a", 2};
    hn_scene *s = NULL;
    hn_diags diags = {0};
    (void)state;
    assert_int_equal(hn_scene_load_json(text, strlen(text), "given", &set, 1, &s, &diags), HN_OK);
    assert_string_equal(s->id, "given");
    assert_near(s->params[0].value, 8 + acos(-1), 1e-15);
    assert_near(s->params[0].initial, 18 + acos(-1), 1e-14);
    assert_near(s->params[1].value, 4, 0);
    hn_scene_free(s);
}

static void parameters_that_bounds_of_repetitions_need_are_structural(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD "\"parameters\":{\"k\":2, \"n\":\"k + 1\", \"m\":1}, "
             "\"bodies\":[{\"for\":{\"i\":[1,\"n\"]},\"name\":\"b{i}\",\"mass\":\"m*i\"}],"
             "\"joints\":[{\"for\":{\"i\":[1,\"n\"]},\"name\":\"j{i}\",\"type\":\"revolute\","
             "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b{n+1-i}\"}}]}");
    (void)state;
    assert_int_equal(s->n_bodies, 3);
    assert_near(s->bodies[2].mass.value, 3, 0);
    assert_string_equal(s->bodies[2].mass.formula, "m*3");
    assert_int_equal(s->joints[0].child, 2);
    assert_true(s->params[0].structural && s->params[1].structural && !s->params[2].structural);
    assert_string_equal(s->coordinates[1].name, "j2");
    assert_string_equal(s->coordinates[1].rate, "d_j2");
    hn_scene_free(s);
}

static void axes_are_made_unit_and_missing_references_are_the_least_aligned_axis(void **state) {
    static const struct {
        const char *axis;
        double unit[3], ref[3];
    } rows[] = {
        {"[0,0,1]", {0, 0, 1}, {1, 0, 0}},     {"[0,0,-5]", {0, 0, -1}, {1, 0, 0}},
        {"[2,0,0]", {1, 0, 0}, {0, 1, 0}},     {"[0,1e-200,0]", {0, 1, 0}, {1, 0, 0}},
        {"[3,4,0]", {0.6, 0.8, 0}, {0, 0, 1}}, {"[0,3e99,4e99]", {0, 0.6, 0.8}, {1, 0, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 HEAD ONE_BODY "\"joints\":[{\"name\":\"j\",\"type\":\"prismatic\",\"axis\":%s,"
                               "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b\"}}]}",
                 rows[i].axis);
        hn_scene *s = hn_test_scene(text);
        assert_all_near(s->joints[0].parent_axis, rows[i].unit, 3, 1e-15);
        assert_all_near(s->joints[0].parent_ref, rows[i].ref, 3, 1e-15);
        assert_all_near(s->joints[0].child_axis, rows[i].unit, 3, 1e-15);
        assert_all_near(s->joints[0].child_ref, rows[i].ref, 3, 1e-15);
        assert_int_equal(s->coordinates[0].kind, HN_LENGTH);
        hn_scene_free(s);
    }
}

static void a_childs_own_axis_and_reference_are_kept(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD ONE_BODY
        "\"joints\":[{\"name\":\"j\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},"
        "\"child\":{\"body\":\"b\",\"axis\":[0,2,0],\"ref\":[0,0,-3]}}]}");
    static const double axis[3] = {0, 1, 0}, ref[3] = {0, 0, -1}, z[3] = {0, 0, 1};
    (void)state;
    assert_all_near(s->joints[0].child_axis, axis, 3, 0);
    assert_all_near(s->joints[0].child_ref, ref, 3, 0);
    assert_all_near(s->joints[0].parent_axis, z, 3, 0);
    hn_scene_free(s);
}

static void inertia_of_a_real_body_is_accepted_however_its_axes_stand(void **state) {
    // a thin plate (xx + yy = zz exactly) turned by 0.3 rad about z, and one by formulas with 3
    // digits
    double c = cos(0.3), sn = sin(0.3), a = 0.02, b = 0.05;
    char text[600];
    (void)state;
    snprintf(text, sizeof text,
             HEAD "\"bodies\":[{\"name\":\"b\",\"mass\":1,\"inertia\":{\"xx\":%.17g,\"yy\":%.17g,"
                  "\"zz\":0.07,\"xy\":%.17g}}], " ONE_JOINT "}",
             a * c * c + b * sn * sn, a * sn * sn + b * c * c, (a - b) * c * sn);
    hn_scene *s = hn_test_scene(text);
    assert_near(s->bodies[0].inertia[3].value, (a - b) * c * sn, 1e-17);
    hn_scene_free(s);
}

static void loads_keep_formulas_that_vary_apart_from_numbers(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD "\"parameters\":{\"k\":50}, " ONE_BODY
             "\"joints\":[{\"name\":\"j\",\"type\":\"revolute\",\"coordinate\":\"q\",\"rate\":"
             "\"w\",\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b\"}}],"
             "\"draw\":{\"points\":{\"tip\":{\"body\":\"b\",\"at\":[1,0]}}},"
             "\"loads\":[{\"spring\":{\"from\":[0,2],\"to\":\"tip\",\"stiffness\":\"k\",\"rest\":0."
             "5,\"damping\":1}},"
             "{\"name\":\"motor\",\"torque\":{\"joint\":\"j\",\"value\":\"k*sin(t) - 2*w\"}},"
             "{\"torque\":{\"coordinate\":\"q\",\"value\":\"2*k\"}},"
             "{\"joint_spring\":{\"joint\":\"j\",\"stiffness\":3,\"rest\":\"pi\"}},"
             "{\"force\":{\"at\":{\"body\":\"b\",\"at\":[1,0]},\"value\":[0,\"-k*q\"]}}]}");
    (void)state;
    assert_int_equal(s->n_loads, 5);
    assert_int_equal(s->loads[0].kind, HN_LOAD_SPRING);
    assert_int_equal(s->points[s->loads[0].p].body, HN_GROUND);
    assert_string_equal(s->points[s->loads[0].q].name, "tip");
    assert_near(s->loads[0].stiffness.value, 50, 0);
    assert_true(s->loads[1].value[0].varies);
    assert_string_equal(s->loads[1].value[0].formula, "k*sin(t) - 2*w");
    assert_false(s->loads[2].value[0].varies);
    assert_near(s->loads[2].value[0].value, 100, 0);
    assert_int_equal(s->loads[3].kind, HN_LOAD_JOINT_SPRING);
    assert_int_equal(s->loads[3].coordinate, 0);
    assert_int_equal(s->loads[4].p, s->loads[0].q); // the same place is the same point
    assert_true(s->loads[4].value[1].varies && !s->loads[4].value[0].varies);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_SPRING), 1);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_DAMPER), 1);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_ARROW), 1);
    hn_scene_free(s);
}

static void what_is_left_undrawn_is_made_from_the_joints(void **state) {
    hn_scene *s = load_set(LESSON "slider-crank.json", NULL, 0);
    (void)state;
    // crank and rod; the slider's joints share one place
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_BAR), 2);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_GROUND), 1);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_PIVOT), 2);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_SLIDER), 1);
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_GUIDE), 1);
    hn_scene_free(s);
}

static void polygons_keep_their_points_in_a_row(void **state) {
    hn_scene *s = hn_test_scene(
        HEAD "\"bodies\":[{\"name\":\"b\",\"mass\":1,\"draw\":[{\"bar\":[[0,0],[1,0]]},{"
             "\"polygon\":[[0,0],[1,0],[1,1],[0,1]],\"width\":0.1}]}], " ONE_JOINT "}");
    (void)state;
    assert_int_equal(hn_test_count_shapes(s, HN_SHAPE_POLYGON), 1);
    const hn_shape *p = &s->shapes[1];
    assert_int_equal(p->n, 4);
    assert_int_equal(p->body, 0);
    static const double x[4] = {0, 1, 1, 0}, y[4] = {0, 0, 1, 1};
    for (int i = 0; i < 4; i++) {
        assert_near(s->points[p->p + i].at[0].value, x[i], 0);
        assert_near(s->points[p->p + i].at[1].value, y[i], 0);
    }
    hn_scene_free(s);
}

static void a_lagrangian_keeps_its_formulas_forces_and_tears(void **state) {
    hn_scene *s = load_set(LESSON "fb0-lagrangian.json", NULL, 0);
    (void)state;
    assert_true(s->lagrangian.kinetic.varies && s->lagrangian.potential.varies);
    assert_string_equal(s->lagrangian.constraint_names[1], "loop y");
    assert_int_equal(s->n_tears, 1);
    assert_string_equal(s->points[s->tears[0][0]].name, "B");
    assert_string_equal(s->points[s->tears[0][1]].name, "B'");
    assert_true(s->points[s->tears[0][1]].at[0].varies);
    hn_scene_free(s);
    s = hn_test_scene(
        HEAD "\"lagrangian\":{\"coordinates\":[{\"for\":{\"i\":[1,2]},\"name\":\"q{i}\",\"rate\":"
             "\"v{i}\",\"unit\":\"m\"}],"
             "\"kinetic\":\"v1^2 + "
             "v2^2\",\"constraints\":[{\"for\":{\"i\":[1,2]},\"formula\":\"q{i} - i*sin(t)\"}],"
             "\"forces\":{\"q1\":\"-v1\",\"q2\":3}}}");
    assert_int_equal(s->n_coordinates, 2);
    assert_string_equal(s->coordinates[1].rate, "v2");
    assert_string_equal(s->lagrangian.constraints[1].formula, "q2 - 2*sin(t)");
    assert_int_equal(s->n_loads, 2);
    assert_int_equal(s->loads[1].coordinate, 1);
    assert_near(s->loads[1].value[0].value, 3, 0);
    hn_scene_free(s);
}

static void a_setting_of_the_start_replaces_what_the_scene_says(void **state) {
    (void)state;
    // a value, a guess and a rate
    hn_setting set[] = {{"start.th1", 1.3}, {"start.a2", -0.7}, {"start.w1", 2}};
    hn_scene *plain = load_set(LESSON "four-bar.json", NULL, 0),
             *moved = load_set(LESSON "four-bar.json", set, 3);
    assert_near(moved->coordinates[0].q0, 1.3, 0);
    assert_near(moved->coordinates[1].q0, -0.7, 0);
    assert_near(moved->coordinates[0].v0, 2, 0);
    assert_false(moved->coordinates[0].q0_pinned);
    assert_near(moved->coordinates[2].q0, plain->coordinates[2].q0, 0);
    assert_true(moved->hash != plain->hash);

    // its text alone is the same scene
    hn_scene *again = hn_test_scene(moved->text);
    assert_true(again->hash == moved->hash);
    assert_near(again->coordinates[0].q0, 1.3, 0);

    // an entry that the scene repeats: "th{i}"
    hn_setting one = {"start.th2", 0.25};
    hn_scene *ladder = load_set(LESSON "n-four-bar.json", &one, 1);
    assert_near(ladder->coordinates[hn_scene_find_coordinate(ladder, "th2")].q0, 0.25, 0);
    hn_scene *all[] = {plain, moved, again, ladder};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        hn_scene_free(all[i]);
    }
}

static void a_setting_of_an_unknown_start_is_named(void **state) {
    (void)state;
    hn_setting set = {"start.th9", 1};
    hn_scene *scene = NULL;
    hn_diags diags = {0};
    assert_int_equal(hn_scene_load_file(LESSON "four-bar.json", &set, 1, &scene, &diags),
                     HN_ERR_INPUT);
    assert_string_equal(diags.item[0].pointer, "/start/moved/th9");
    assert_null(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_setting_of_the_start_replaces_what_the_scene_says),
        cmocka_unit_test(a_setting_of_an_unknown_start_is_named),
        cmocka_unit_test(scenes_load_with_their_sizes),
        cmocka_unit_test(fb0_has_the_numbers_of_the_reference),
        cmocka_unit_test(the_ladder_grows_with_its_parameter),
        cmocka_unit_test(the_tilted_four_bar_has_unit_axes_and_the_inertia_of_thin_rods),
        cmocka_unit_test(the_hash_is_of_what_moves_not_of_words_or_white_space),
        cmocka_unit_test(energy_and_loop_of_fb0_are_those_of_its_reference_motion),
        cmocka_unit_test(parameters_may_be_formulas_of_each_other_in_any_order),
        cmocka_unit_test(parameters_that_bounds_of_repetitions_need_are_structural),
        cmocka_unit_test(axes_are_made_unit_and_missing_references_are_the_least_aligned_axis),
        cmocka_unit_test(a_childs_own_axis_and_reference_are_kept),
        cmocka_unit_test(inertia_of_a_real_body_is_accepted_however_its_axes_stand),
        cmocka_unit_test(loads_keep_formulas_that_vary_apart_from_numbers),
        cmocka_unit_test(what_is_left_undrawn_is_made_from_the_joints),
        cmocka_unit_test(polygons_keep_their_points_in_a_row),
        cmocka_unit_test(a_lagrangian_keeps_its_formulas_forces_and_tears),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
