// SPDX-License-Identifier: GPL-3.0-or-later
// Forces in joints: balance of every body from poses alone, cases worked out by hand, and
// independence of the cut.
#include "support/near.h"

#include "dynamics/assembly/project.h"
#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/reactions/reactions.h"
#include "support/balance.h"
#include "support/mechanism.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_J = 16, MAX_N = 48 };

typedef struct carried {
    hn_wrench joints[MAX_J], constraints[MAX_J];
    double defect;
    double a[MAX_N], lambda[MAX_N];
} carried;

/// Accelerations, multipliers and wrenches at a state.
static void solve(const hn_system *sys, hn_arena *arena, double t, const double *q, const double *v,
                  carried *out) {
    hn_accel *accel = NULL;
    hn_accel_info info;
    hn_reactions *r = NULL;
    hn_diag diag = {0};
    assert_true(hn_system_scene(sys)->n_joints <= MAX_J);
    assert_int_equal(hn_accel_create(sys, &(hn_accel_opts){.want_lambda = 1}, arena, &accel),
                     HN_OK);
    assert_int_equal(hn_accel_eval(accel, t, q, v, 0, 0, out->a, out->lambda, &info), HN_OK);
    assert_int_equal(hn_reactions_create(sys, arena, &r, &diag), HN_OK);
    assert_int_equal(
        hn_reactions_eval(r, t, q, v, out->a, out->lambda, out->joints, out->constraints), HN_OK);
    out->defect = hn_reactions_defect(r);
    hn_reactions_free(r);
    hn_accel_free(accel);
}

static void check_balance(const char *what, unsigned seed, const hn_system *sys, const double *q,
                          const double *v, const carried *c) {
    const balance b = balance_of(sys, 0, q, v, c->a, c->joints, c->constraints);
    const double size = 1 + b.largest_force + b.largest_moment;
    // differences lose 1e-16 / H^2 of lengths times masses
    if (!(b.force <= 1e-7 * size && b.moment <= 1e-7 * size)) {
        fail_msg("%s %u: %g N and %g N m are missing of %g N, %g N m", what, seed, b.force,
                 b.moment, b.largest_force, b.largest_moment);
    }
    for (int i = 0; i < 3;
         i++) { // what the ground gives, and the weight, is all that changes the momentum
        if (hn_system_scene(sys)->n_loads == 0) {
            assert_near(-b.on_ground[i] + b.weight[i], b.momentum_rate[i], 1e-7 * size);
        }
    }
    assert_near(c->defect, 0, 1e-9);
}

/// Speeds that the closed pose allows.
static void close_speeds(const hn_system *sys, hn_arena *arena, const double *q, double *v) {
    hn_projector *projector = NULL;
    assert_int_equal(hn_projector_create(sys, HN_WEIGHT_MASS, arena, &projector), HN_OK);
    assert_int_equal(hn_project_velocity(projector, 0, q, v, NULL), HN_OK);
    hn_projector_free(projector);
}

static void every_body_of_random_mechanisms_is_in_balance(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 60; seed++) {
        const mechanism_opts o = {.seed = 7000 + seed,
                                  .n_bodies = 2 + (int)seed % 5,
                                  .n_cuts = (int)seed % 3,
                                  .parallel = 0.5,
                                  .prismatic = 0.3,
                                  .mixed = seed % 2 ? 0.7 : 0,
                                  .planar = seed % 4 == 0};
        hn_arena *arena = hn_arena_create(0);
        hn_scene *scene = mechanism_random(arena, &o);
        hn_system *sys = NULL;
        hn_diags diags = {0};
        carried c;
        double user[MAX_N], q[MAX_N], v[MAX_N];
        unsigned noise = seed;
        assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_OK);
        const hn_system_info info = hn_system_get_info(sys);
        assert_true(info.nq <= MAX_N && info.nc <= MAX_N);
        for (int i = 0; i < info.nv; i++) {
            user[i] = scene->coordinates[hn_system_user_coordinate(sys, i)].q0;
            v[i] = random_signed(&noise);
        }
        hn_system_from_user(sys, user, q);
        close_speeds(sys, arena, q, v);
        solve(sys, arena, 0, q, v, &c);
        check_balance("mechanism", seed, sys, q, v, &c);
        hn_system_free(sys);
        hn_arena_free(arena);
    }
}

static void open_and_solve(hn_model *m, const char *json, carried *c) {
    hn_model_open_text(m, json, NULL);
    solve(m->sys, m->arena, 0, m->q, m->v, c);
    check_balance("text", 0, m->sys, m->q, m->v, c);
}

static void a_pendulum_s_pin_carries_weight_along_the_rod_and_centrifugal_force(void **state) {
    (void)state;
    const double m = 2, l = 0.7, th = 0.5, w = 3, g = 9.81; // th from hanging down
    hn_model model;
    carried c;
    open_and_solve(
        &model,
        "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81],\"bodies\":[{\"name\":\"bob\","
        "\"mass\":2,\"com\":[0,-0.7]}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\","
        "\"parent\":{\"body\":\"ground\",\"at\":[0,0,0]},\"child\":{\"body\":\"bob\",\"at\":[0,0,0]"
        "},\"coordinate\":"
        "\"th\",\"rate\":\"w\"}],\"start\":{\"positions\":{\"th\":0.5},\"rates\":{\"w\":3}}}",
        &c);
    const double up[2] = {-sin(th), cos(th)}; // from the bob to the pin
    const double along = c.joints[0].force[0] * up[0] + c.joints[0].force[1] * up[1];
    const double across = c.joints[0].force[0] * up[1] - c.joints[0].force[1] * up[0];
    assert_near(along, m * (g * cos(th) + l * w * w), 1e-12);
    assert_near(across, 0, 1e-12); // a point mass: the rod only pulls
    assert_near(c.joints[0].moment[2], 0, 1e-13);
    hn_model_close(&model);
}

// two rods of a wall bracket under a weight: pulled sqrt(2) W along the tie, pushed W along the
// strut. The rods are massless bodies
static void a_bracket_carries_its_weight_as_statics_says(void **state) {
    (void)state;
    hn_model model;
    carried c;
    open_and_solve(
        &model,
        "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"strut\",\"mass\":1,\"com\":[1,0],"
        "\"inertia\":{\"zz\":0.1}},{\"name\":\"tie\",\"mass\":1,\"com\":[0.5,0],\"inertia\":{"
        "\"zz\":"
        "0.1}}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\","
        "\"at\":[0,0,0]},"
        "\"child\":{\"body\":\"strut\"},\"coordinate\":\"s\"},{\"name\":\"B\",\"type\":"
        "\"revolute\","
        "\"parent\":{\"body\":\"ground\",\"at\":[0,1]},\"child\":{\"body\":\"tie\"},\"coordinate\":"
        "\"u\"},{\"name\":\"C\",\"type\":\"revolute\",\"cut\":true,\"parent\":{\"body\":\"strut\","
        "\"at\":[1,0]},\"child\":{\"body\":\"tie\",\"at\":[1.4142135623730951,0]}}],"
        "\"loads\":[{\"force\":{\"at\":{\"body\":\"strut\",\"at\":[1,0]},\"value\":[0,-100]}}],"
        "\"start\":{\"positions\":{\"s\":0,\"u\":{\"guess\":-0.785}}}}",
        &c);
    const double expected[3][2] = {{100, 0}, {-100, 100}, {100, -100}}; // on strut, on tie, on tie
    for (int j = 0; j < 3; j++) {
        assert_near(c.joints[j].force[0], expected[j][0], 1e-9);
        assert_near(c.joints[j].force[1], expected[j][1], 1e-9);
        assert_near(c.joints[j].moment[2], 0, 1e-9);
        assert_int_equal(c.joints[j].determined, 1);
    }
    hn_model_close(&model);
}

#define FOUR_BAR(cutA, cutB, cutC, cutD)                                                           \
    "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81],\"bodies\":[{\"name\":\"crank\","         \
    "\"mass\":1,\"com\":[0.2,0.05],\"inertia\":{\"zz\":0.02}},{\"name\":\"coupler\",\"mass\":2,"   \
    "\"com\":[0.5,0],\"inertia\":{\"zz\":0.1}},{\"name\":\"rocker\",\"mass\":1.5,\"com\":[0.3,0]," \
    "\"inertia\":{\"zz\":0.05}}],\"joints\":[{\"name\":\"A\",\"type\":\"revolute\"" cutA           \
    ",\"parent\":{\"body\":\"ground\",\"at\":[0,0,0]},\"child\":{\"body\":\"crank\"},"             \
    "\"coordinate\":\"a\"},"                                                                       \
    "{\"name\":\"B\",\"type\":\"revolute\"" cutB                                                   \
    ",\"parent\":{\"body\":\"crank\",\"at\":[0.4,0]},"                                             \
    "\"child\":{\"body\":\"coupler\"},\"coordinate\":\"b\"},{\"name\":\"C\",\"type\":"             \
    "\"revolute\"" cutC ",\"parent\":{\"body\":\"coupler\",\"at\":[1,0]},\"child\":{\"body\":"     \
    "\"rocker\",\"at\":[0.7,0]},\"coordinate\":\"c\"},{\"name\":\"D\",\"type\":\"revolute\"" cutD  \
    ",\"parent\":{\"body\":\"ground\",\"at\":[1.1,0]},\"child\":{\"body\":\"rocker\"},"            \
    "\"coordinate\":\"d\"}],\"loads\":[{\"torque\":{\"joint\":\"%s\",\"value\":3}},"               \
    "{\"joint_spring\":{\"joint\":\"%s\",\"stiffness\":5,\"rest\":0.3}}],\"start\":{"              \
    "\"positions\":{%s},"                                                                          \
    "\"rates\":{%s}}}"

static void solve_cut(const char *json, carried *c) {
    hn_model m;
    hn_model_open_text(&m, json, NULL);
    solve(m.sys, m.arena, 0, m.q, m.v, c);
    check_balance("four-bar", 0, m.sys, m.q, m.v, c);
    hn_model_close(&m);
}

// the very same motion with each joint cut in turn; actuator at B and a spring along D, whether in
// the tree or not
static void reactions_do_not_depend_on_which_joint_is_cut(void **state) {
    (void)state;
    static const char CUT[] = ",\"cut\":true";
    carried ref, c;
    char text[2600];
    for (int cut = 1; cut < 4; cut++) { // B, C, D; the drive at A needs its own coordinate
        const char *k[4] = {"", "", "", ""};
        char positions[80];
        k[cut] = CUT;
        snprintf(positions, sizeof positions, "\"a\":0.9,\"%s\":{\"guess\":%g}",
                 cut == 3 ? "b" : "d", cut == 3 ? -0.7 : 1.6);
        snprintf(text, sizeof text, FOUR_BAR("%s", "%s", "%s", "%s"), k[0], k[1], k[2], k[3], "B",
                 "D", positions, "\"d_a\":2");
        solve_cut(text, cut == 1 ? &ref : &c);
        for (int j = 0; j < 4 && cut > 1; j++) {
            assert_all_near(c.joints[j].force, ref.joints[j].force, 3, 1e-9);
            assert_all_near(c.joints[j].moment, ref.joints[j].moment, 3, 1e-9);
        }
    }
}

// a four-bar whose plane is known twice over: one joint's forces out of the plane cannot be told
// apart from another's
static void redundant_rows_are_told_at_the_joints_they_touch(void **state) {
    (void)state;
    hn_model m;
    carried c;
    hn_model_open_closed(&m, "fb0-redundant", NULL);
    solve(m.sys, m.arena, 0, m.q, m.v, &c);
    int n = 0;
    for (int j = 0; j < m.scene->n_joints; j++) {
        n += !c.joints[j].determined;
    }
    assert_true(n > 0);
    check_balance("redundant", 0, m.sys, m.q, m.v, &c);
    hn_model_close(&m);
}

/// A bob of 2 kg that hangs 1 m below the origin, from the ground to the bob or the other way
/// round.
static void hang(const char *joints, const char *constraints, carried *c, hn_model *m) {
    char json[1024];
    snprintf(
        json, sizeof json,
        "{\"holonom\":1,\"name\":\"bob\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"bob\","
        "\"mass\":2,\"inertia\":{\"zz\":0.1}}],\"joints\":[%s]%s%s}",
        joints, constraints[0] ? ",\"start\":{\"positions\":{\"y\":-1}},\"constraints\":" : "",
        constraints);
    open_and_solve(m, json, c);
}

// one convention: a wrench acts on the second partner
static void a_hanging_weight_is_held_up_whatever_holds_it(void **state) {
    (void)state;
    static const char slide[] =
        "{\"name\":\"S\",\"type\":\"prismatic\",\"axis\":[0,1,0],\"ref\":[1,0,0],"
        "\"parent\":{\"body\":\"ground\",\"at\":[0,0,0]},\"child\":{\"body\":\"bob\",\"at\":[0,0,0]"
        "},"
        "\"coordinate\":\"y\"}";
    static const struct {
        const char *joints, *constraints;
        double joint, constraint; // upward force on the partner that the convention names
        int body;
    } cases[] = {
        {"{\"name\":\"W\",\"type\":\"fixed\",\"parent\":{\"body\":\"ground\",\"at\":[0,-1,0]},"
         "\"child\":{\"body\":\"bob\",\"at\":[0,0,0]}}",
         "", 2 * 9.81, 0, 0},
        {"{\"name\":\"W\",\"type\":\"fixed\",\"parent\":{\"body\":\"bob\",\"at\":[0,0,0]},"
         "\"child\":{\"body\":\"ground\",\"at\":[0,-1,0]}}",
         "", -2 * 9.81, 0, HN_GROUND},
        {NULL,
         "[{\"name\":\"rod\",\"distance\":{\"from\":{\"body\":\"ground\",\"at\":[0,0,0]},\"to\":{"
         "\"body\":\"bob\",\"at\":[0,0,0]}"
         ","
         "\"length\":1}}]",
         0, 2 * 9.81, 0},
        {NULL,
         "[{\"name\":\"rod\",\"distance\":{\"from\":{\"body\":\"bob\",\"at\":[0,0,0]},\"to\":{"
         "\"body\":\"ground\",\"at\":[0,0,0]}"
         ","
         "\"length\":1}}]",
         0, -2 * 9.81, HN_GROUND},
        {NULL,
         "[{\"name\":\"shelf\",\"plane\":{\"point\":{\"body\":\"bob\",\"at\":[0,0,0]},\"through\":{"
         "\"body\":"
         "\"ground\",\"at\":[0,0,0]},"
         "\"direction\":[0,1,0],\"offset\":-1}}]",
         0, 2 * 9.81, 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        carried c;
        hn_model m;
        hang(cases[k].joints ? cases[k].joints : slide, cases[k].constraints, &c, &m);
        assert_near(c.joints[0].force[1], cases[k].joint, 1e-12);
        if (cases[k].constraints[0]) {
            assert_near(c.constraints[0].force[1], cases[k].constraint, 1e-12);
            assert_int_equal(c.constraints[0].body, cases[k].body);
        } else {
            assert_int_equal(c.joints[0].body, cases[k].body);
        }
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_body_of_random_mechanisms_is_in_balance),
        cmocka_unit_test(a_pendulum_s_pin_carries_weight_along_the_rod_and_centrifugal_force),
        cmocka_unit_test(a_bracket_carries_its_weight_as_statics_says),
        cmocka_unit_test(reactions_do_not_depend_on_which_joint_is_cut),
        cmocka_unit_test(redundant_rows_are_told_at_the_joints_they_touch),
        cmocka_unit_test(a_hanging_weight_is_held_up_whatever_holds_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
