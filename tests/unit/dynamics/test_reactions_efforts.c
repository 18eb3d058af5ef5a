// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of formulas on joints: efforts along coordinates against closed forms, the same springs
// written both ways, and the balance of every body from differences of its poses.
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/reactions/reactions.h"
#include "support/balance.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 16 };

typedef struct carried {
    hn_model m;
    hn_reactions *r;
    hn_wrench joints[MOST], constraints[MOST];
    double a[MOST], user_a[MOST], lambda[MOST];
} carried;

/// A scene at its start, and what is carried there.
static void begin(carried *c, const char *text) {
    hn_accel *accel = NULL;
    hn_diag diag = {0};
    *c = (carried){.r = NULL};
    hn_model_open_text(&c->m, text, NULL);
    const hn_model *m = &c->m;
    assert_int_equal(m->status, HN_OK);
    assert_true(m->info.nv <= MOST && m->info.nc <= MOST && m->scene->n_joints <= MOST &&
                m->scene->n_constraints <= MOST);
    assert_int_equal(hn_accel_create(m->sys, &(hn_accel_opts){.want_lambda = 1}, m->arena, &accel),
                     HN_OK);
    assert_int_equal(hn_accel_eval(accel, 0, m->q, m->v, 0, 0, c->a, c->lambda, NULL), HN_OK);
    hn_system_rates_to_user(m->sys, c->a, c->user_a);
    assert_int_equal(hn_reactions_create(m->sys, m->arena, &c->r, &diag), HN_OK);
    assert_int_equal(
        hn_reactions_eval(c->r, 0, m->q, m->v, c->a, c->lambda, c->joints, c->constraints), HN_OK);
    hn_accel_free(accel);
}

static void end(carried *c) {
    hn_reactions_free(c->r);
    hn_model_close(&c->m);
}

/// Newton and Euler for each body, and the work of the wrenches along the freedoms of the tree's
/// joints.
static void check_balance(const carried *c) {
    const balance b = balance_of(c->m.sys, 0, c->m.q, c->m.v, c->a, c->joints, c->constraints);
    // differences of poses lose 1e-16 / step^2 of lengths times masses
    const double size = 1 + b.largest_force + b.largest_moment;
    assert_near(b.force, 0, 1e-7 * size);
    assert_near(b.moment, 0, 1e-7 * size);
    // the solve for accelerations leaves some roundings of the largest term
    assert_near(hn_reactions_defect(c->r), 0, 1e-12);
}

static const hn_effort *find_effort(const carried *c, const char *name, const char *coordinate,
                                    hn_effort *out) {
    for (int k = 0; k < hn_reactions_effort_count(c->r); k++) {
        *out = hn_reactions_effort(c->r, k);
        if (strcmp(out->name, name) == 0 &&
            strcmp(c->m.scene->coordinates[out->coordinate].name, coordinate) == 0) {
            return out;
        }
    }
    return NULL;
}

static double effort(const carried *c, const char *name, const char *coordinate) {
    hn_effort e;
    assert_non_null(find_effort(c, name, coordinate, &e));
    return e.value;
}

// ---- one link ----

#define LINK                                                                                 \
    "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81,0],\"bodies\":[{\"name\":\"link\","  \
    "\"mass\":1.3,\"com\":[0.5,0,0],\"inertia\":{\"zz\":0.2}}],\"joints\":[{\"name\":\"O\"," \
    "\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"link\"},"  \
    "\"coordinate\":\"a\",\"rate\":\"w\"}],"

static const char BEAD[] =
    LINK "\"lagrangian\":{\"coordinates\":[{\"name\":\"s\",\"rate\":\"ds\",\"unit\":\"m\"}],"
         "\"kinetic\":\"0.8/2*((0.7+s)^2*w^2+ds^2)\","
         "\"potential\":\"0.8*9.81*(0.7+s)*sin(a)+40*s^2/2\"},"
         "\"start\":{\"positions\":{\"a\":0.4,\"s\":0.05},\"rates\":{\"a\":1.7,\"s\":-0.6}}}";

// Q = -(r^2 m w)' - m g r cos a is what the bead does to the angle; the pin holds the link against
// the link's own inertia alone
static void a_pin_carries_what_formulas_do_along_its_freedom(void **state) {
    (void)state;
    carried c;
    begin(&c, BEAD);
    const double a = 0.4, r = 0.75, w = 1.7, ds = -0.6, al = c.user_a[0], g = 9.81;
    const double Q = -0.8 * (2 * r * ds * w + r * r * al) - 0.8 * g * r * cos(a);
    assert_near(effort(&c, "energies", "a"), Q, 1e-12 * (1 + fabs(Q)));
    assert_near(c.joints[0].moment[2], Q, 1e-12 * (1 + fabs(Q)));
    assert_near(c.joints[0].force[0], 1.3 * 0.5 * (-w * w * cos(a) - al * sin(a)), 1e-11);
    assert_near(c.joints[0].force[1], 1.3 * (0.5 * (-w * w * sin(a) + al * cos(a)) + g), 1e-11);
    assert_int_equal(c.joints[0].determined, 1);
    hn_effort e;
    assert_null(find_effort(&c, "energies", "s", &e)); // no joint has s
    check_balance(&c);
    end(&c);
}

static const char GEARED[] =
    LINK "\"lagrangian\":{\"coordinates\":[{\"name\":\"u\",\"rate\":\"du\"}],"
         "\"kinetic\":\"0.03*du^2/2\",\"constraints\":[{\"name\":\"gear\",\"formula\":\"u-5*a\"}]},"
         "\"start\":{\"positions\":{\"a\":0.4},\"rates\":{\"a\":1.7}}}";

// a rotor behind a gear of 5 resists the link as 25 times its inertia would
static void a_geared_rotor_is_felt_at_the_pin(void **state) {
    (void)state;
    carried c;
    begin(&c, GEARED);
    const double al = c.user_a[0], inertia = 0.2 + 1.3 * 0.25 + 25 * 0.03;
    assert_near(al, -1.3 * 9.81 * 0.5 * cos(0.4) / inertia, 1e-12);
    assert_near(effort(&c, "gear", "a"), -25 * 0.03 * al, 1e-12);
    assert_near(effort(&c, "gear", "u"), 5 * 0.03 * al, 1e-12);
    assert_near(c.joints[0].moment[2], -25 * 0.03 * al, 1e-12);
    assert_int_equal(hn_reactions_has_place(c.r, 0), 0); // it is listed once, as efforts
    check_balance(&c);
    end(&c);
}

static const char APART[] =
    LINK "\"lagrangian\":{\"coordinates\":[{\"name\":\"u\",\"rate\":\"du\"},"
         "{\"name\":\"s\",\"rate\":\"ds\",\"unit\":\"m\"}],"
         "\"kinetic\":\"0.03*du^2/2+2*ds^2/2\",\"potential\":\"2*9.81*s\","
         "\"constraints\":[{\"name\":\"drum\",\"formula\":\"s-0.1*u\"}]},"
         "\"start\":{\"positions\":{\"a\":0.4,\"u\":0}}}";

// a weight on a drum: m (g + s'') along the rope and 0.1 of it at the drum, and nothing of it at
// the pin of the link beside it
static void constraints_of_formulas_alone_have_efforts_and_no_place(void **state) {
    (void)state;
    carried c;
    begin(&c, APART);
    const double down = -2 * 9.81 / (2 + 0.03 / 0.01);
    assert_near(effort(&c, "drum", "s"), 2 * (9.81 + down), 1e-12);
    assert_near(effort(&c, "drum", "u"), -0.1 * 2 * (9.81 + down), 1e-12);
    assert_int_equal(hn_reactions_has_place(c.r, 0), 0);
    assert_near(c.constraints[0].moment[2], 0, 0);
    assert_near(c.joints[0].moment[2], 0, 1e-12);
    check_balance(&c);
    end(&c);
}

// ---- a closed loop ----

#define BAR(name, mass, half) \
    "{\"name\":\"" name "\",\"mass\":" mass ",\"com\":[" half ",0,0],\"inertia\":{\"zz\":0.1}}"
#define PIN(name, parent, at, child, child_at, x)                                                  \
    "{\"name\":\"" name "\",\"type\":\"revolute\",\"parent\":{\"body\":\"" parent "\",\"at\":[" at \
    ",0,0]},\"child\":{\"body\":\"" child "\",\"at\":[" child_at ",0,0]},\"coordinate\":\"" x      \
    "\",\"rate\":\"d" x "\""
// clang-format off
#define FOUR_BAR \
    "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81,0],\"bodies\":[" \
    BAR("crank", "1", "0.5") "," BAR("coupler", "2", "1.5") "," BAR("rocker", "1.5", "1") \
    "],\"joints\":[" PIN("A", "ground", "0", "crank", "0", "a") "}," \
    PIN("B", "crank", "1", "coupler", "0", "b") "}," \
    PIN("C", "coupler", "3", "rocker", "2", "c") ",\"cut\":true}," \
    PIN("D", "ground", "2.5", "rocker", "0", "d") "}]," \
    "\"start\":{\"positions\":{\"a\":1.1,\"b\":{\"guess\":-0.6},\"d\":{\"guess\":1.6}}," \
    "\"rates\":{\"a\":2.3}}"
// clang-format on

static const char SPRINGS[] = FOUR_BAR
    ",\"loads\":[{\"name\":\"at C\",\"joint_spring\":{\"joint\":\"C\",\"stiffness\":7}},"
    "{\"name\":\"at B\",\"joint_spring\":{\"joint\":\"B\",\"stiffness\":3,\"rest\":0.2}}]}";
static const char POTENTIAL[] =
    FOUR_BAR ",\"lagrangian\":{\"potential\":\"7*c^2/2+3*(b-0.2)^2/2\"}}";

static void a_potential_of_joint_angles_is_springs_in_those_joints(void **state) {
    (void)state;
    carried springs, formulas;
    begin(&springs, SPRINGS);
    begin(&formulas, POTENTIAL);
    const hn_model *m = &formulas.m;
    const double b = m->user_q[hn_model_user(m, "b")];
    const double c = m->user_q[hn_model_user(m, "d")] - m->user_q[hn_model_user(m, "a")] - b;
    assert_near(effort(&formulas, "energies", "b"), -3 * (b - 0.2), 1e-12);
    assert_near(effort(&formulas, "energies", "c"), -7 * c, 1e-12);
    for (int j = 0; j < 4; j++) {
        const hn_wrench *one = &springs.joints[j], *two = &formulas.joints[j];
        for (int i = 0; i < 3; i++) { // the same numbers by other roundings
            assert_near(one->force[i], two->force[i], 1e-11 * (1 + fabs(one->force[i])));
            assert_near(one->moment[i], two->moment[i], 1e-11 * (1 + fabs(one->moment[i])));
        }
    }
    check_balance(&formulas);
    end(&formulas);
    end(&springs);
}

static const char ROTORS[] = FOUR_BAR ",\"lagrangian\":{\"kinetic\":"
                                      "\"(2+cos(a))*dc^2/2+0.4*da*dc+0.3*dd^2\","
                                      "\"potential\":\"7*sin(c)*a\"}}";

// T = (2 + cos a) c'^2 / 2 + 0.4 a' c' + 0.3 d'^2 and V = 7 a sin c, by Lagrange's rule on paper; C
// is the joint that is cut
static void energies_act_in_the_joints_of_a_loop(void **state) {
    (void)state;
    carried s;
    begin(&s, ROTORS);
    const int ia = hn_model_user(&s.m, "a"), ib = hn_model_user(&s.m, "b"),
              id = hn_model_user(&s.m, "d");
    const double *q = s.m.user_q, *v = s.m.user_v, *x = s.user_a;
    const double a = q[ia], c = q[id] - q[ia] - q[ib], dc = v[id] - v[ia] - v[ib],
                 ddc = x[id] - x[ia] - x[ib];
    const double Qa = -sin(a) * dc * dc / 2 - 0.4 * ddc - 7 * sin(c);
    const double Qc = sin(a) * v[ia] * dc - (2 + cos(a)) * ddc - 0.4 * x[ia] - 7 * a * cos(c);
    const double size = 1 + fabs(Qa) + fabs(Qc) + fabs(ddc);
    assert_near(effort(&s, "energies", "a"), Qa, 1e-13 * size);
    assert_near(effort(&s, "energies", "c"), Qc, 1e-13 * size);
    assert_near(effort(&s, "energies", "d"), -0.6 * x[id], 1e-13 * size);
    hn_effort none;
    assert_null(find_effort(&s, "energies", "b", &none));
    const double along[4] = {Qa, 0, Qc, -0.6 * x[id]};
    for (int j = 0; j < 4; j++) { // the solve leaves some roundings
        assert_near(s.joints[j].moment[2], along[j], 1e-11 * size);
    }
    check_balance(&s);
    end(&s);
}

#define SLIDE                                                               \
    "{\"name\":\"S\",\"type\":\"prismatic\",\"cut\":true,\"axis\":[1,0,0]," \
    "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"slider\"},"     \
    "\"coordinate\":\"x\",\"rate\":\"vx\"}]"
#define SLIDER_START                                                                      \
    ",\"start\":{\"positions\":{\"a\":0.9,\"b\":{\"guess\":-1.2},\"c\":{\"guess\":0.3}}," \
    "\"rates\":{\"a\":2.3}}"
#define CRANK_AND_ROD BAR("crank", "1", "0.5") "," BAR("rod", "2", "1.5")
#define SLIDER_PINS                                                                                \
    PIN("O", "ground", "0", "crank", "0", "a")                                                     \
    "}," PIN("A", "crank", "1", "rod", "0", "b") "}," PIN("B", "rod", "3", "slider", "0", "c") "}" \
                                                                                               ","
#define SLIDER(mass)                                           \
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[" CRANK_AND_ROD \
    ",{\"name\":\"slider\",\"mass\":" mass "}],\"joints\":[" SLIDER_PINS SLIDE SLIDER_START

// the way of the cut joint is no linear map of the tree's angles: its acceleration has a part that
// is there without theirs
static void mass_on_a_slide_may_be_a_formula_of_the_cut_joint(void **state) {
    (void)state;
    carried heavy, light;
    begin(&heavy, SLIDER("1.2") "}");
    begin(&light, SLIDER("0.5") ",\"lagrangian\":{\"kinetic\":\"0.7*vx^2/2\"}}");
    const double a = 0.9, w = 2.3, al = light.user_a[0];
    const double s = -sin(a) / 3, c = sqrt(1 - s * s), turn = -cos(a) * w / (3 * c),
                 turning = (sin(a) * w * w - cos(a) * al + 3 * s * turn * turn) / (3 * c);
    const double way = -sin(a) * al - cos(a) * w * w - 3 * s * turning - 3 * c * turn * turn;
    assert_near(effort(&light, "energies", "x"), -0.7 * way, 1e-11 * (1 + fabs(way)));
    assert_near(light.joints[3].force[0], -0.7 * way, 1e-11 * (1 + fabs(way)));
    assert_near(heavy.joints[3].force[0], 0, 1e-11 * (1 + fabs(way)));
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++) { // the same numbers by other roundings
            const double force = heavy.joints[j].force[i], moment = heavy.joints[j].moment[i];
            assert_near(light.joints[j].force[i], force, 1e-11 * (1 + fabs(force)));
            assert_near(light.joints[j].moment[i], moment, 1e-11 * (1 + fabs(moment)));
        }
    }
    check_balance(&light);
    end(&light);
    end(&heavy);
}

/// A shipped scene with a Lagrangian beside its bodies.
static void begin_shipped(carried *c, const char *scene, const char *lagrangian) {
    enum { ROOM = 1 << 15 };
    char path[200], *text = calloc(1, ROOM);
    snprintf(path, sizeof path, "lessons/09-space-and-drives/scenes/%s.json", scene);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    size_t n = fread(text, 1, ROOM - 1, f);
    fclose(f);
    while (n > 0 && text[n] != '}') {
        n--;
    }
    assert_true(n > 0 && n + strlen(lagrangian) + 32 < ROOM);
    snprintf(text + n, ROOM - n, ",\"lagrangian\":{%s}}", lagrangian);
    begin(c, text);
    free(text);
}

// what acts along the first coordinate is not zero, so none of these could do without it
static void bodies_in_space_are_in_balance_with_formulas_in_their_joints(void **state) {
    (void)state;
    static const struct {
        const char *scene, *first, *lagrangian;
    } rows[] = {
        {"rssr", "th",
         "\"kinetic\":\"(0.2+0.1*cos(ps))*w^2/2+0.05*w*wps+0.1*wps^2\","
         "\"potential\":\"3*sin(th)*ps\""},
        {"spatial-slider-crank", "th",
         "\"kinetic\":\"0.2*w^2/2+0.1*sin(th)*w*vx\",\"potential\":\"20*x^2+sin(th)\""},
        {"cardan-shaft", "th1",
         "\"kinetic\":\"0.2*w1^2/2+0.1*w1*w3\",\"potential\":\"2*a1^2+3*(b1+0.5)*sin(th1+0.7)\""},
        {"planetary-gear", "s",
         "\"kinetic\":\"0.01*ws^2+0.02*(wp1-ws)^2\",\"potential\":\"sin(s+0.4)*(p2+1)\""},
        {"delta-robot", "th1",
         "\"coordinates\":[{\"name\":\"u\",\"rate\":\"du\"}],\"kinetic\":\"0.001*du^2/2\","
         "\"potential\":\"0.3*sin(th2)\","
         "\"constraints\":[{\"name\":\"gear\",\"formula\":\"u-20*th1\"}]"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        carried c;
        hn_effort e;
        begin_shipped(&c, rows[k].scene, rows[k].lagrangian);
        assert_true(find_effort(&c, "energies", rows[k].first, &e) ||
                    find_effort(&c, "gear", rows[k].first, &e));
        if (!(fabs(e.value) > 1e-3)) {
            fail_msg("%s: %g along %s", rows[k].scene, e.value, rows[k].first);
        }
        const balance b = balance_of(c.m.sys, 0, c.m.q, c.m.v, c.a, c.joints, c.constraints);
        const double size = 1 + b.largest_force + b.largest_moment;
        // differences: 1e-16 / step^2 of lengths times masses, and (speed step)^4 / 90 of
        // accelerations
        if (!(b.force <= 1e-6 * size && b.moment <= 1e-6 * size)) {
            fail_msg("%s: %g N and %g N m are missing", rows[k].scene, b.force, b.moment);
        }
        assert_near(hn_reactions_defect(c.r), 0, 1e-11);
        end(&c);
    }
}

// ---- formulas alone ----

// M a = f + J' lambda: the rows' efforts along each coordinate are all that is missing
static void efforts_of_a_lagrangian_s_rows_are_what_its_motion_lacks(void **state) {
    (void)state;
    carried c = {.r = NULL};
    hn_accel *accel = NULL;
    hn_eval *eval = NULL;
    hn_model_open_closed(&c.m, "fb0-lagrangian", NULL);
    const hn_model *m = &c.m;
    const int n = m->info.nv;
    assert_int_equal(hn_reactions_create(m->sys, m->arena, &c.r, NULL), HN_OK);
    assert_int_equal(hn_accel_create(m->sys, &(hn_accel_opts){.want_lambda = 1}, m->arena, &accel),
                     HN_OK);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_M | HN_TERM_F, m->arena, &eval), HN_OK);
    assert_int_equal(hn_accel_eval(accel, 0, m->q, m->v, 0, 0, c.a, c.lambda, NULL), HN_OK);
    assert_int_equal(hn_reactions_eval(c.r, 0, m->q, m->v, c.a, c.lambda, NULL, NULL), HN_OK);
    hn_eval_run(eval, 0, m->q, m->v);
    const double *M = hn_eval_get(eval, HN_TERM_M), *f = hn_eval_get(eval, HN_TERM_F);
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double lacks = -f[i], given = 0, size = fabs(f[i]);
        for (int j = 0; j < n; j++) {
            lacks += M[i * n + j] * c.a[j];
            size += fabs(M[i * n + j] * c.a[j]);
        }
        for (int k = 0; k < hn_reactions_effort_count(c.r); k++) {
            const hn_effort e = hn_reactions_effort(c.r, k);
            assert_int_equal(e.determined, 1);
            given += e.coordinate == i ? e.value : 0;
        }
        assert_near(given, lacks, 1e-12 * (1 + size));
        largest = fmax(largest, fabs(given));
    }
    assert_true(largest > 0.1);
    hn_eval_free(eval);
    hn_accel_free(accel);
    end(&c);
}

static const char TWICE[] =
    "{\"holonom\":1,\"name\":\"x\",\"lagrangian\":{\"coordinates\":["
    "{\"name\":\"x\",\"rate\":\"dx\",\"unit\":\"m\"},{\"name\":\"y\",\"rate\":\"dy\",\"unit\":"
    "\"m\"},"
    "{\"name\":\"z\",\"rate\":\"dz\",\"unit\":\"m\"}],"
    "\"kinetic\":\"(dx^2+dy^2+dz^2)/2\",\"potential\":\"9.81*y+9.81*z\",\"constraints\":["
    "{\"name\":\"floor\",\"formula\":\"y\"},{\"name\":\"carpet\",\"formula\":\"2*y\"},"
    "{\"name\":\"shelf\",\"formula\":\"z\"}]}}";

static void efforts_of_rows_that_say_the_same_are_told_as_undetermined(void **state) {
    (void)state;
    carried c;
    hn_effort floor, carpet, shelf;
    begin(&c, TWICE);
    assert_non_null(find_effort(&c, "floor", "y", &floor));
    assert_non_null(find_effort(&c, "carpet", "y", &carpet));
    assert_non_null(find_effort(&c, "shelf", "z", &shelf));
    assert_near(floor.value + carpet.value, 9.81, 1e-12);
    assert_near(shelf.value, 9.81, 1e-12);
    assert_true(!floor.determined && !carpet.determined && shelf.determined);
    end(&c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pin_carries_what_formulas_do_along_its_freedom),
        cmocka_unit_test(a_geared_rotor_is_felt_at_the_pin),
        cmocka_unit_test(constraints_of_formulas_alone_have_efforts_and_no_place),
        cmocka_unit_test(a_potential_of_joint_angles_is_springs_in_those_joints),
        cmocka_unit_test(energies_act_in_the_joints_of_a_loop),
        cmocka_unit_test(mass_on_a_slide_may_be_a_formula_of_the_cut_joint),
        cmocka_unit_test(bodies_in_space_are_in_balance_with_formulas_in_their_joints),
        cmocka_unit_test(efforts_of_a_lagrangian_s_rows_are_what_its_motion_lacks),
        cmocka_unit_test(efforts_of_rows_that_say_the_same_are_told_as_undetermined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
