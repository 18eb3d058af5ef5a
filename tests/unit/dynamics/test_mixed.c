// SPDX-License-Identifier: GPL-3.0-or-later
// A Lagrangian's terms beside bodies: the same mechanism written in both ways, and closed forms.
#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define UPPER                                                                                   \
    "\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81,0],\"parameters\":{\"l1\":1,\"l2\":0.7," \
    "\"m1\":1.3,\"m2\":0.8,\"g\":9.81,\"k\":40},"
#define LINK_1                                                    \
    "{\"name\":\"upper\",\"mass\":\"m1\",\"com\":[\"l1/2\",0,0]," \
    "\"inertia\":{\"zz\":\"m1*l1^2/12\"}}"
#define JOINT_O                                                               \
    "{\"name\":\"O\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"}," \
    "\"child\":{\"body\":\"upper\"},\"coordinate\":\"a\",\"rate\":\"w\"}"

static const char ALL_BODIES[] =
    "{" UPPER "\"bodies\":[" LINK_1 ",{\"name\":\"lower\",\"mass\":\"m2\",\"com\":[\"l2/2\",0,0],"
    "\"inertia\":{\"zz\":\"m2*l2^2/12\"}}],"
    "\"joints\":[" JOINT_O
    ",{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":\"upper\",\"at\":[\"l1\",0,0]},"
    "\"child\":{\"body\":\"lower\"},\"coordinate\":\"b\",\"rate\":\"u\"}]}";

static const char SECOND_LINK_AS_FORMULAS[] =
    "{" UPPER "\"bodies\":[" LINK_1 "],\"joints\":[" JOINT_O "],\"lagrangian\":{"
    "\"coordinates\":[{\"name\":\"b\",\"rate\":\"u\",\"unit\":\"rad\"}],"
    "\"kinetic\":\"m2/2*((-l1*sin(a)*w-l2/2*sin(a+b)*(w+u))^2"
    "+(l1*cos(a)*w+l2/2*cos(a+b)*(w+u))^2)+m2*l2^2/24*(w+u)^2\","
    "\"potential\":\"m2*g*(l1*sin(a)+l2/2*sin(a+b))\"}}";

// a bead on the upper link, held at l2 from the pivot by a spring
static const char ELASTIC[] =
    "{" UPPER "\"bodies\":[" LINK_1 "],\"joints\":[" JOINT_O "],\"lagrangian\":{"
    "\"coordinates\":[{\"name\":\"s\",\"rate\":\"ds\",\"unit\":\"m\"}],"
    "\"kinetic\":\"m2/2*((l2+s)^2*w^2+ds^2)\","
    "\"potential\":\"m2*g*(l2+s)*sin(a)+k*s^2/2\"}}";

typedef struct setup {
    hn_arena *arena;
    hn_scene *scene;
    hn_system *sys;
    hn_accel *accel;
    hn_eval *eval;
} setup;

static void begin(setup *s, const char *text) {
    hn_diags diags = {0};
    *s = (setup){.arena = hn_arena_create(0)};
    if (hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &s->scene, &diags) != HN_OK ||
        hn_system_compile(s->scene, NULL, &s->sys, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    const hn_accel_opts opts = {.want_lambda = 1};
    assert_int_equal(hn_accel_create(s->sys, &opts, s->arena, &s->accel), HN_OK);
    const unsigned terms = HN_TERM_ENERGY | HN_TERM_PHI | HN_TERM_J;
    assert_int_equal(hn_eval_create(s->sys, terms, s->arena, &s->eval), HN_OK);
}

static void end(setup *s) {
    hn_eval_free(s->eval);
    hn_accel_free(s->accel);
    hn_system_free(s->sys);
    hn_scene_free(s->scene);
    hn_arena_free(s->arena);
}

/// Accelerations and energy at a state of two scene coordinates.
static double accelerate(setup *s, const double user_q[2], const double user_v[2], double a[2]) {
    double q[2], v[2], own[2], lambda[2] = {0, 0};
    hn_accel_info info;
    assert_int_equal(hn_system_get_info(s->sys).nv, 2);
    hn_system_from_user(s->sys, user_q, q);
    hn_system_rates_from_user(s->sys, user_v, v);
    assert_int_equal(hn_accel_eval(s->accel, 0, q, v, 0, 0, own, lambda, &info), HN_OK);
    hn_system_rates_to_user(s->sys, own, a);
    hn_eval_run(s->eval, 0, q, v);
    const double *energy = hn_eval_get(s->eval, HN_TERM_ENERGY);
    return energy[0] + energy[1];
}

static void state_of(int k, double q[2], double v[2]) {
    q[0] = 0.4 + 1.3 * k;
    q[1] = 0.9 - 0.7 * k;
    v[0] = 0.3 - 0.9 * k;
    v[1] = -0.5 + 1.1 * k;
}

static void a_link_as_formulas_moves_as_the_link_does(void **state) {
    (void)state;
    setup bodies, mixed;
    begin(&bodies, ALL_BODIES);
    begin(&mixed, SECOND_LINK_AS_FORMULAS);
    for (int k = 0; k < 12; k++) {
        double q[2], v[2], a[2] = {999, 999}, b[2] = {-999, -999};
        state_of(k, q, v);
        const double energy = accelerate(&bodies, q, v, a), same = accelerate(&mixed, q, v, b);
        // two formulas of one thing in doubles, M is well conditioned: rounding of some tens of
        // operations
        const double size = 1 + fabs(a[0]) + fabs(a[1]);
        assert_near(b[0], a[0], 1e-12 * size);
        assert_near(b[1], a[1], 1e-12 * size);
        assert_near(same, energy, 1e-12 * (1 + fabs(energy)));
    }
    end(&mixed);
    end(&bodies);
}

// with r = l2 + s:  s'' = r w^2 - g sin a - k s / m2,
// (m1 l1^2 / 3 + m2 r^2) a'' = -2 m2 r s' w - (m1 l1 / 2 + m2 r) g cos a
static void an_elastic_pendulum_follows_its_closed_form(void **state) {
    (void)state;
    const double l1 = 1, l2 = 0.7, m1 = 1.3, m2 = 0.8, g = 9.81, stiffness = 40;
    setup s;
    begin(&s, ELASTIC);
    for (int k = 0; k < 12; k++) {
        double q[2], v[2], a[2] = {999, 999};
        state_of(k, q, v);
        q[1] *= 0.05; // stays clear of r = 0
        accelerate(&s, q, v, a);
        const double r = l2 + q[1], inertia = m1 * l1 * l1 / 3 + m2 * r * r;
        const double turn =
            (-2 * m2 * r * v[1] * v[0] - (m1 * l1 / 2 + m2 * r) * g * cos(q[0])) / inertia;
        const double way = r * v[0] * v[0] - g * sin(q[0]) - stiffness * q[1] / m2;
        assert_near(a[0], turn, 1e-12 * (1 + fabs(turn)));
        assert_near(a[1], way, 1e-12 * (1 + fabs(way)));
    }
    end(&s);
}

// b follows a as a gear would: one row over a joint's coordinate and an own one, and the freedom is
// lost
static void constraints_reach_over_both_kinds_of_coordinates(void **state) {
    (void)state;
    char text[2048];
    const size_t n = sizeof SECOND_LINK_AS_FORMULAS - 3; // without the last two braces
    snprintf(text, sizeof text,
             "%.*s,\"constraints\":[{\"name\":\"gear\",\"formula\":\"b-2*a\"}]}}", (int)n,
             SECOND_LINK_AS_FORMULAS);
    setup s;
    begin(&s, text);
    assert_int_equal(hn_system_get_info(s.sys).nc, 1);
    const double q[2] = {0.3, 0.6}, v[2] = {0.5, 1};
    double a[2] = {999, 999};
    accelerate(&s, q, v, a);
    assert_near(hn_eval_get(s.eval, HN_TERM_PHI)[0], 0, 1e-15);
    assert_near(a[1], 2 * a[0], 1e-13 * (1 + fabs(a[1])));
    end(&s);
}

static void is_refused(const char *text, const char *because) {
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    hn_diags diags = {0};
    hn_status status = hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, &diags);
    if (status == HN_OK) {
        status = hn_system_compile(scene, NULL, &sys, &diags);
    }
    assert_int_not_equal(status, HN_OK);
    assert_non_null(strstr(diags.item[0].message, because));
    hn_scene_free(scene);
}

#define BALL                                                                               \
    "{" UPPER "\"bodies\":[{\"name\":\"b\",\"mass\":1,\"inertia\":{\"xx\":1,\"yy\":1,"     \
    "\"zz\":1}}],\"joints\":[{\"name\":\"S\",\"type\":\"spherical\",\"parent\":{\"body\":" \
    "\"ground\"},\"child\":{\"body\":\"b\"}}],\"lagrangian\":{"

static void entries_of_orientations_are_refused(void **state) {
    (void)state;
    is_refused(BALL "\"potential\":\"S_rx^2\"}}", "rotation vector");
    is_refused(BALL "\"kinetic\":\"d_S_rx^2\"}}", "angular velocity");
}

static void what_formulas_cannot_be_is_told(void **state) {
    (void)state;
    const char *const start = "{" UPPER "\"bodies\":[" LINK_1 "],\"joints\":[" JOINT_O "],";
    static const struct {
        const char *lagrangian, *because;
    } bad[] = {
        {"{}", "empty"},
        {"{\"kinetic\":\"w^3\"}", "quadratic"},
        {"{\"potential\":\"a*w\"}", "rate"},
        {"{\"coordinates\":[{\"name\":\"a\"}],\"potential\":\"a\"}", "taken already"},
        {"{\"coordinates\":[{\"name\":\"c\"}],\"potential\":\"c\"}", "moves no mass"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[2048];
        snprintf(text, sizeof text, "%s\"lagrangian\":%s}", start, bad[i].lagrangian);
        is_refused(text, bad[i].because);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_link_as_formulas_moves_as_the_link_does),
        cmocka_unit_test(an_elastic_pendulum_follows_its_closed_form),
        cmocka_unit_test(constraints_reach_over_both_kinds_of_coordinates),
        cmocka_unit_test(entries_of_orientations_are_refused),
        cmocka_unit_test(what_formulas_cannot_be_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
