// SPDX-License-Identifier: GPL-3.0-or-later
// Whole scenes, compiled: what is refused and why, loads against their power, formulas, telling.
#include "support/near.h"

#include "dynamics/analyse/inspect.h"
#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "support/mechanism.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct model {
    hn_scene *scene;
    hn_system *sys;
    hn_arena *arena;
    hn_eval *eval;
    int n, m;
} model;

static hn_status compile_text(const char *text, model *out, hn_diags *diags) {
    memset(out, 0, sizeof *out);
    memset(diags, 0, sizeof *diags);
    hn_status status = hn_scene_load_json(text, strlen(text), "test", NULL, 0, &out->scene, diags);
    if (status != HN_OK) {
        fail_msg("the scene does not load: %s %s", diags->item[0].pointer, diags->item[0].message);
    }
    status = hn_system_compile(out->scene, NULL, &out->sys, diags);
    if (status != HN_OK) {
        assert_null(out->sys);
        hn_scene_free(out->scene);
    }
    return status;
}

static model open_text(const char *text) {
    model m;
    hn_diags diags;
    hn_status status = compile_text(text, &m, &diags);
    if (status != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    m.arena = hn_arena_create(0);
    m.n = hn_system_get_info(m.sys).nv;
    m.m = hn_system_get_info(m.sys).nc;
    assert_int_equal(hn_eval_create(m.sys, (1u << HN_TERM_COUNT) - 1, m.arena, &m.eval), HN_OK);
    return m;
}

static void close_model(model *m) {
    hn_eval_free(m->eval);
    hn_system_free(m->sys);
    hn_arena_free(m->arena);
    hn_scene_free(m->scene);
}

static const double *term(model *m, hn_term which, double t, const double *q, const double *v) {
    hn_eval_run(m->eval, t, q, v);
    return hn_eval_get(m->eval, which);
}

// ---- refusals ----

#define BAR(name) \
    "{\"name\": \"" name "\", \"mass\": 1, \"com\": [0.5, 0, 0], \"inertia\": {\"zz\": 0.1}}"

static void a_loop_that_can_never_close_is_told_with_its_offset(void **state) {
    (void)state;
    // a planar loop whose last joint sits 0.05 m off the plane
    static const char text[] = "{\"holonom\": 1, \"name\": \"off\", \"bodies\": [" BAR("a") "," BAR(
        "b") "," BAR("c") "],"
                          "\"joints\": ["
                          "{\"name\": \"O\", \"type\": \"revolute\", \"parent\": {\"body\": "
                          "\"ground\"}, \"child\": {\"body\": \"a\"}},"
                          "{\"name\": \"P\", \"type\": \"revolute\", \"parent\": {\"body\": "
                          "\"ground\", \"at\": [2, 0, 0]}, \"child\": {\"body\": \"c\"}},"
                          "{\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"a\", "
                          "\"at\": [1, 0, 0]}, \"child\": {\"body\": \"b\"}},"
                          "{\"name\": \"B\", \"type\": \"revolute\", \"parent\": {\"body\": \"b\", "
                          "\"at\": [2, 0, 0.05]},"
                          " \"child\": {\"body\": \"c\", \"at\": [1, 0, 0]}, \"cut\": true}]}";
    model m;
    hn_diags diags;
    assert_int_equal(compile_text(text, &m, &diags), HN_ERR_INPUT);
    assert_non_null(strstr(diags.item[0].message, "B"));
    assert_non_null(strstr(diags.item[0].message, "0.05 m"));
    assert_string_equal(diags.item[0].pointer, "/joints/3");
}

static void a_freedom_without_mass_is_told(void **state) {
    (void)state;
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"light\", \"bodies\": [{\"name\": \"a\", \"mass\": 0}],"
        "\"joints\": [{\"name\": \"O\", \"type\": \"revolute\", \"parent\": {\"body\": "
        "\"ground\"}, \"child\": {\"body\": \"a\"},"
        "\"coordinate\": \"th\"}]}";
    model m;
    hn_diags diags;
    assert_int_equal(compile_text(text, &m, &diags), HN_ERR_INPUT);
    assert_non_null(strstr(diags.item[0].message, "'th'"));
}

static void a_kinetic_energy_that_is_not_quadratic_is_refused(void **state) {
    (void)state;
    static const char *const kinetic[3] = {"w^2/2 + w*x", "w^4", "(1 + t)*w^2/2"};
    for (int k = 0; k < 3; k++) {
        char text[512];
        snprintf(text, sizeof text,
                 "{\"holonom\": 1, \"name\": \"odd\", \"lagrangian\": {\"coordinates\": "
                 "[{\"name\": \"x\", \"rate\": \"w\"}],"
                 "\"kinetic\": \"%s\", \"potential\": \"x^2\"}}",
                 kinetic[k]);
        model m;
        hn_diags diags;
        assert_int_equal(compile_text(text, &m, &diags), HN_ERR_INPUT);
        assert_non_null(strstr(diags.item[0].message, "quadratic"));
    }
}

// ---- Lagrangians ----

static void a_constraint_that_moves_with_time_has_all_its_derivatives(void **state) {
    (void)state;
    // x^2 + y^2 = (1 + t/2)^2
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"growing\", \"lagrangian\": {\"coordinates\": [{\"name\": "
        "\"x\", \"rate\": \"vx\"}, {\"name\": \"y\", \"rate\": \"vy\"}],"
        "\"kinetic\": \"(vx^2 + vy^2)/2\", \"potential\": \"9.81*y\", \"constraints\": [{\"name\": "
        "\"rod\", \"formula\": \"x^2 + y^2 - (1 + t/2)^2\"}]}}";
    model m = open_text(text);
    const double q[2] = {0.3, -0.8}, v[2] = {0.7, 1.1}, t = 0.6;
    assert_int_equal(hn_system_get_info(m.sys).has_time, 1);
    assert_near(term(&m, HN_TERM_PHI, t, q, v)[0], 0.09 + 0.64 - 1.69, 1e-15);
    assert_near(term(&m, HN_TERM_PHI_T, t, q, v)[0], -1.3, 1e-15);
    assert_near(term(&m, HN_TERM_J, t, q, v)[0], 0.6, 1e-15);
    assert_near(term(&m, HN_TERM_J, t, q, v)[1], -1.6, 1e-15);
    assert_near(term(&m, HN_TERM_GAMMA, t, q, v)[0], 2 * (0.49 + 1.21) - 0.5, 1e-15);
    assert_near(term(&m, HN_TERM_F, t, q, v)[1], -9.81, 1e-15);
    close_model(&m);
}

static void mass_that_depends_on_the_coordinates_gives_its_bias(void **state) {
    (void)state;
    // a bead on a turning rod: T = m (r'^2 + r^2 w^2) / 2
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"bead\", \"lagrangian\": {\"coordinates\": [{\"name\": \"r\", "
        "\"rate\": \"u\"}, {\"name\": \"a\", \"rate\": \"w\"}],"
        "\"kinetic\": \"3*(u^2 + r^2*w^2)/2\", \"potential\": \"5*r\"}}";
    model m = open_text(text);
    const double q[2] = {1.5, 0.2}, v[2] = {0.4, -2};
    const double M[4] = {3, 0, 0, 3 * 2.25}, f[2] = {3 * 1.5 * 4 - 5, -2 * 3 * 1.5 * 0.4 * -2};
    assert_all_near(term(&m, HN_TERM_M, 0, q, v), M, 4, 1e-14);
    assert_all_near(term(&m, HN_TERM_F, 0, q, v), f, 2, 1e-14);
    close_model(&m);
}

// ---- loads ----

#define TWO_LINKS                                                                               \
    "{\"holonom\": 1, \"name\": \"loads\", \"bodies\": [" BAR("a") "," BAR(                     \
        "b") "],"                                                                               \
             "\"joints\": ["                                                                    \
             "{\"name\": \"O\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\"}, "   \
             "\"child\": {\"body\": \"a\"}, \"coordinate\": \"p\", \"rate\": \"pd\"},"          \
             "{\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"a\", \"at\": " \
             "[1, 0, 0]}, \"child\": {\"body\": \"b\"}, \"coordinate\": \"r\", \"rate\": "      \
             "\"rd\"}],"

/// f . v must be the power of the loads alone: gravity is off, and M a + h at v is taken from the
/// same scene without loads.
static double power_of_loads(const char *text, const double *user_q, const double *user_v,
                             double t) {
    model with = open_text(text), without = open_text(TWO_LINKS "\"duration\": 1}");
    double q[2], v[2], power = 0;
    hn_system_from_user(with.sys, user_q, q);
    hn_system_rates_from_user(with.sys, user_v, v);
    const double *f = term(&with, HN_TERM_F, t, q, v), *none = term(&without, HN_TERM_F, t, q, v);
    for (int i = 0; i < 2; i++) {
        power += (f[i] - none[i]) * v[i];
    }
    close_model(&with);
    close_model(&without);
    return power;
}

/// Tip of the second bar, and its velocity.
static void tip(const double *q, const double *v, double x[2], double xd[2]) {
    double s1 = sin(q[0]), c1 = cos(q[0]), s2 = sin(q[0] + q[1]), c2 = cos(q[0] + q[1]),
           w = v[0] + v[1];
    x[0] = c1 + c2;
    x[1] = s1 + s2;
    xd[0] = -s1 * v[0] - s2 * w;
    xd[1] = c1 * v[0] + c2 * w;
}

static const double Q[2] = {0.4, -1.1}, V[2] = {1.3, 0.6};

static void a_torque_on_a_joint_works_on_that_joint_alone(void **state) {
    (void)state;
    static const char text[] = TWO_LINKS
        "\"loads\": [{\"torque\": {\"coordinate\": \"r\", \"value\": \"3*t - 2*p + rd\"}}]}";
    double tau = 3 * 0.5 - 2 * Q[0] + V[1];
    assert_near(power_of_loads(text, Q, V, 0.5), tau * V[1], 1e-14);
}

static void a_force_at_a_point_works_on_the_points_velocity(void **state) {
    (void)state;
    static const char text[] = TWO_LINKS "\"loads\": [{\"force\": {\"at\": {\"body\": \"b\", "
                                         "\"at\": [1, 0, 0]}, \"value\": [\"2*t\", -3, 0]}}]}";
    double x[2], xd[2];
    tip(Q, V, x, xd);
    assert_near(power_of_loads(text, Q, V, 0.5), 1 * xd[0] - 3 * xd[1], 1e-14);
}

static void a_spring_takes_what_its_energy_loses_and_its_damper_only_takes(void **state) {
    (void)state;
    static const char text[] =
        TWO_LINKS "\"loads\": [{\"spring\": {\"from\": {\"body\": \"ground\", \"at\": [0.5, 2, 0]},"
                  "\"to\": {\"body\": \"b\", \"at\": [1, 0, 0]}, \"stiffness\": 7, \"rest\": 0.6, "
                  "\"damping\": 0.3}}]}";
    double x[2], xd[2];
    tip(Q, V, x, xd);
    double d[2] = {x[0] - 0.5, x[1] - 2}, l = hypot(d[0], d[1]),
           rate = (d[0] * xd[0] + d[1] * xd[1]) / l;
    assert_near(power_of_loads(text, Q, V, 0), -(7 * (l - 0.6) + 0.3 * rate) * rate, 1e-13);
    model m = open_text(text);
    double q[2], v[2] = {0, 0};
    hn_system_from_user(m.sys, Q, q);
    assert_near(term(&m, HN_TERM_ENERGY, 0, q, v)[1], 7 * (l - 0.6) * (l - 0.6) / 2, 1e-13);
    close_model(&m);
}

static void a_spring_on_a_joint_pulls_to_its_rest(void **state) {
    (void)state;
    static const char text[] = TWO_LINKS "\"loads\": [{\"joint_spring\": {\"coordinate\": \"r\", "
                                         "\"stiffness\": 4, \"rest\": 0.5, \"damping\": 0.2}}]}";
    assert_near(power_of_loads(text, Q, V, 0), -(4 * (Q[1] - 0.5) + 0.2 * V[1]) * V[1], 1e-14);
}

static void the_coordinate_of_a_cut_joint_follows_from_the_absolute_angles(void **state) {
    (void)state;
    // the cut joint B runs from b to c: its angle is theta_c - theta_b; P is written the other way
    // round
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"cut\", \"bodies\": [" BAR("a") "," BAR("b") "," BAR(
            "c") "],"
                 "\"joints\": ["
                 "{\"name\": \"O\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\"}, "
                 "\"child\": {\"body\": \"a\"}, \"coordinate\": \"p\", \"rate\": \"pd\"},"
                 "{\"name\": \"P\", \"type\": \"revolute\", \"parent\": {\"body\": \"c\"}, "
                 "\"child\": {\"body\": \"ground\", \"at\": [2, 0, 0]}, \"coordinate\": \"s\", "
                 "\"rate\": \"sd\"},"
                 "{\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"a\", \"at\": "
                 "[1, 0, 0]}, \"child\": {\"body\": \"b\"}, \"coordinate\": \"r\", \"rate\": "
                 "\"rd\"},"
                 "{\"name\": \"B\", \"type\": \"revolute\", \"parent\": {\"body\": \"b\", \"at\": "
                 "[2, 0, 0]},"
                 " \"child\": {\"body\": \"c\", \"at\": [1, 0, 0]}, \"cut\": true, \"coordinate\": "
                 "\"z\", \"rate\": \"zd\"}],"
                 "\"loads\": [{\"torque\": {\"joint\": \"B\", \"value\": \"3*t*(5*z + 2*zd)\"}}]}";
    model m = open_text(text);
    const double user_q[3] = {0.3, -0.7, 0.9}, user_v[3] = {1.1, 0.4, -2}; // p, s, r
    double q[3], v[3], power = 0, none[3];
    hn_system_from_user(m.sys, user_q, q);
    hn_system_rates_from_user(m.sys, user_v, v);
    memcpy(none, term(&m, HN_TERM_F, 0, q, v), sizeof none); // at t = 0 the torque is off
    const double *f = term(&m, HN_TERM_F, 1, q, v);
    for (int i = 0; i < 3; i++) {
        power += (f[i] - none[i]) * v[i];
    }
    // theta_a = p, theta_b = p + r, theta_c = -s
    double z = -user_q[1] - user_q[0] - user_q[2], zd = -user_v[1] - user_v[0] - user_v[2];
    assert_near(power, 3 * (5 * z + 2 * zd) * zd, 1e-12);
    close_model(&m);
}

// ---- a spatial closed loop ----

/// Bennett's linkage: four skew hinges, opposite links alike, a / sin(alpha) = b / sin(beta). Link
/// k carries the next hinge at (length, 0, 0), turned by the twist about x; the ground is the
/// fourth link.
static hn_scene *bennett(hn_arena *arena, double alpha, double beta, double b) {
    const double length[4] = {1, b, 1, b}, twist[4] = {alpha, beta, alpha, beta};
    const mechanism_opts o = {.seed = 1, .n_bodies = 3, .n_cuts = 1};
    hn_scene *s = mechanism_random(arena, &o); // for its masses
    for (int i = 0; i < 4; i++) {
        const char *name = s->joints[i].name;
        s->joints[i] = (hn_joint){.name = name,
                                  .pointer = "",
                                  .type = HN_JOINT_REVOLUTE,
                                  .parent = i - 1,
                                  .coordinate = i,
                                  .child = i < 3 ? i : HN_GROUND,
                                  .cut = i == 3,
                                  .parent_ref = {1, 0, 0},
                                  .child_ref = {1, 0, 0},
                                  .parent_axis = {0, 0, 1},
                                  .child_axis = {0, 0, 1}};
        hn_joint *j = &s->joints[i];
        if (i > 0) {
            j->parent_at[0].value = length[i - 1];
            j->parent_axis[1] = -sin(twist[i - 1]);
            j->parent_axis[2] = cos(twist[i - 1]);
        }
    }
    hn_joint *last = &s->joints[3]; // seen back from the first hinge
    last->child_at[0].value = -length[3];
    last->child_axis[1] = sin(twist[3]);
    last->child_axis[2] = cos(twist[3]);
    return s;
}

static void a_bennett_linkage_moves_although_its_rows_outnumber_its_speeds(void **state) {
    (void)state;
    const double alpha = 0.6, beta = 1.1, b = sin(beta) / sin(alpha);
    hn_arena *arena = hn_arena_create(0);
    hn_scene *s = bennett(arena, alpha, beta, b);
    hn_system *sys;
    hn_eval *e;
    hn_accel *accel;
    hn_accel_info info;
    hn_diags diags = {0};
    const hn_accel_opts opts = {.want_lambda = 1};
    assert_int_equal(hn_system_compile(s, NULL, &sys, &diags), HN_OK);
    assert_int_equal(hn_system_get_info(sys).nc, 5);
    assert_int_equal(hn_eval_create(sys, HN_TERM_PHI | HN_TERM_J | HN_TERM_GAMMA, arena, &e),
                     HN_OK);
    assert_int_equal(hn_accel_create(sys, &opts, arena, &accel), HN_OK);

    // its one freedom: tan(th1/2) tan(th2/2) = sin((beta + alpha)/2) / sin((beta - alpha)/2), th3 =
    // -th1
    const double ratio = sin((beta + alpha) / 2) / sin((beta - alpha) / 2);
    const double th1 = 0.9, th2 = 2 * atan(ratio / tan(th1 / 2)), user_q[3] = {th1, th2, -th1};
    double q[3], v[3] = {0, 0, 0}, a[3], lambda[5], scale = 0;
    hn_system_from_user(sys, user_q, q);
    hn_eval_run(e, 0, q, v);
    for (int k = 0; k < 5; k++) {
        assert_near(hn_eval_get(e, HN_TERM_PHI)[k], 0, 1e-14);
    }
    // the rates that all five rows allow: across two of them, and then across the others by
    // themselves
    const double *J = hn_eval_get(e, HN_TERM_J);
    for (int r = 1; r < 5 && scale < 1e-3; r++) {
        for (int i = 0; i < 3; i++) {
            v[i] =
                J[(i + 1) % 3] * J[3 * r + (i + 2) % 3] - J[(i + 2) % 3] * J[3 * r + (i + 1) % 3];
        }
        scale = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    for (int i = 0; i < 3; i++) {
        v[i] *= 2 / scale;
    }
    for (int k = 0; k < 5; k++) {
        assert_near(J[3 * k] * v[0] + J[3 * k + 1] * v[1] + J[3 * k + 2] * v[2], 0, 1e-13);
    }
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
    assert_int_equal(info.fallback, 1);
    assert_int_equal(info.rank, 2);
    hn_eval_run(e, 0, q, v);
    for (int k = 0; k < 5; k++) {
        double row = hn_eval_get(e, HN_TERM_GAMMA)[k];
        assert_near(row + J[3 * k] * a[0] + J[3 * k + 1] * a[1] + J[3 * k + 2] * a[2], 0, 1e-11);
    }
    hn_eval_free(e);
    hn_accel_free(accel);
    hn_system_free(sys);
    hn_arena_free(arena);
}

// ---- telling and size ----

static void inspect_tells_the_tree_the_cut_and_exact_counts(void **state) {
    (void)state;
    hn_scene *scene;
    hn_system *sys;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_int_equal(
        hn_scene_load_file("lessons/01-closed-loops/scenes/fb0.json", NULL, 0, &scene, &diags),
        HN_OK);
    assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_OK);
    hn_json_object(&b);
    assert_int_equal(hn_system_inspect_put(&b, sys), HN_OK);
    hn_json_end_object(&b);
    cJSON *doc = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(doc);
    const cJSON *tree = cJSON_GetObjectItem(doc, "tree");
    assert_int_equal(cJSON_GetArraySize(tree), 4);
    assert_string_equal(cJSON_GetArrayItem(tree, 2)->valuestring, "    coupler by revolute A");
    const cJSON *loop = cJSON_GetArrayItem(cJSON_GetObjectItem(doc, "loops"), 0);
    assert_string_equal(cJSON_GetObjectItem(loop, "joint")->valuestring, "B");
    const cJSON *dropped = cJSON_GetArrayItem(cJSON_GetObjectItem(doc, "left_out"), 0);
    assert_int_equal(cJSON_GetObjectItem(dropped, "count")->valueint, 3);
    hn_arena *arena = hn_arena_create(0);
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_accel *accel;
    assert_int_equal(hn_accel_create(sys, &opts, arena, &accel), HN_OK);
    assert_int_equal(cJSON_GetObjectItem(cJSON_GetObjectItem(doc, "operations"), "solve")->valueint,
                     hn_accel_tape_info(accel).ops);
    hn_accel_free(accel);
    hn_arena_free(arena);
    cJSON_Delete(doc);

    hn_strbuf_clear(&b);
    hn_drawing_json(&b, sys);
    doc = cJSON_Parse(hn_strbuf_text(&b));
    const cJSON *tear = cJSON_GetArrayItem(cJSON_GetObjectItem(doc, "tears"), 0);
    // the halves of the cut joint are the points in which the coupler's and the rocker's bars end
    static const char *const halves[] = {"p", "q"};
    for (int half = 0; half < 2; half++) {
        const int point = cJSON_GetObjectItem(tear, halves[half])->valueint;
        const cJSON *shape;
        int ends = 0;
        cJSON_ArrayForEach(shape, cJSON_GetObjectItem(doc, "shapes")) {
            ends += strcmp(cJSON_GetObjectItem(shape, "kind")->valuestring, "bar") == 0 &&
                    cJSON_GetObjectItem(shape, "q")->valueint == point;
        }
        assert_int_equal(ends, 1);
    }
    assert_string_equal(cJSON_GetObjectItem(tear, "name")->valuestring, "B");
    cJSON_Delete(doc);
    hn_strbuf_reset(&b);
    hn_system_free(sys);
    hn_scene_free(scene);
}

/// Operations of one evaluation; *nodes of the graph behind it: what compiling it costs.
static int ladder_ops(int loops, int *nodes) {
    const hn_setting set = {"N", loops};
    hn_scene *scene;
    hn_system *sys;
    hn_accel *accel;
    hn_diags diags = {0};
    assert_int_equal(hn_scene_load_file("lessons/01-closed-loops/scenes/n-four-bar.json", &set, 1,
                                        &scene, &diags),
                     HN_OK);
    hn_arena *arena = hn_arena_create(0);
    const hn_accel_opts opts = {.want_lambda = 1};
    assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_OK);
    assert_int_equal(hn_accel_create(sys, &opts, arena, &accel), HN_OK);
    *nodes = hn_graph_size(hn_system_graph(sys));
    int ops = hn_accel_tape_info(accel).ops;
    hn_accel_free(accel);
    hn_system_free(sys);
    hn_arena_free(arena);
    hn_scene_free(scene);
    return ops;
}

static void
a_ladder_of_200_loops_costs_as_much_a_loop_as_one_of_10_to_compile_and_to_evaluate(void **state) {
    (void)state;
    int few_nodes, many_nodes;
    double ten = ladder_ops(10, &few_nodes) / 10.0, many = ladder_ops(200, &many_nodes) / 200.0;
    assert_true(many < 1.3 * ten && ten < 1.3 * many);
    assert_true(many < 200);
    assert_true(many_nodes / 200.0 < 1.3 * few_nodes / 10.0);
}

static void symbolic_parameters_change_nothing_in_the_numbers(void **state) {
    (void)state;
    hn_scene *scene;
    hn_system *sys[2];
    hn_diags diags = {0};
    hn_arena *arena = hn_arena_create(0);
    assert_int_equal(hn_scene_load_file("lessons/01-closed-loops/scenes/slider-crank.json", NULL, 0,
                                        &scene, &diags),
                     HN_OK);
    double values[2][3];
    for (int k = 0; k < 2; k++) {
        const hn_system_opts opts = {.symbolic_params = k};
        assert_int_equal(hn_system_compile(scene, &opts, &sys[k], &diags), HN_OK);
        const double user_q[3] = {0.7, -0.9, 1.4}, user_v[3] = {1, 2, -1};
        double q[3], v[3];
        hn_eval *e;
        assert_int_equal(hn_eval_create(sys[k], HN_TERM_F, arena, &e), HN_OK);
        hn_system_from_user(sys[k], user_q, q);
        hn_system_rates_from_user(sys[k], user_v, v);
        hn_eval_run(e, 0, q, v);
        hn_system_forces_to_user(sys[k], hn_eval_get(e, HN_TERM_F), values[k]);
        hn_eval_free(e);
    }
    assert_all_near(values[1], values[0], 3, 1e-12);
    hn_system_free(sys[0]);
    hn_system_free(sys[1]);
    hn_arena_free(arena);
    hn_scene_free(scene);
}

/// An open chain of n links along x, hanging from the ground.
static void write_chain(hn_strbuf *b, int n) {
    hn_strbuf_printf(
        b,
        "{\"holonom\":1,\"name\":\"chain\",\"title\":\"open chain\",\"about\":\"links in a row\","
        "\"gravity\":[0,-9.81,0],\"bodies\":[{\"for\":{\"i\":[0,%d]},\"name\":\"b{i}\",\"mass\":1,"
        "\"com\":[0.5,0,0],\"inertia\":{\"zz\":0.0833}}],\"joints\":[{\"name\":\"j0\",\"type\":"
        "\"revolute\",\"parent\":{\"body\":\"ground\",\"at\":[0,0,0]},\"child\":{\"body\":\"b0\","
        "\"at\":[0,0,0]},\"axis\":[0,0,1],\"coordinate\":\"q0\"},{\"for\":{\"i\":[1,%d]},\"name\":"
        "\"j{i}\",\"type\":\"revolute\",\"parent\":{\"body\":\"b{i-1}\",\"at\":[1,0,0]},\"child\":"
        "{\"body\":\"b{i}\",\"at\":[0,0,0]},\"axis\":[0,0,1],\"coordinate\":\"q{i}\"}],"
        "\"duration\":1,\"step\":0.001,\"methods\":[\"index1@rk4:h=1e-3\"]}",
        n - 1, n - 1);
}

// its mass matrix is full: unrolled, the solve would grow with the cube of the links, so the dense
// solve answers
static void a_matrix_that_is_not_sparse_is_not_unrolled(void **state) {
    (void)state;
    enum { LINKS = 80 };
    for (int unrolled = 0; unrolled < 2; unrolled++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        write_chain(&b, unrolled ? LINKS / 4 : LINKS);
        model m = open_text(hn_strbuf_text(&b));
        hn_accel *accel = NULL;
        assert_int_equal(hn_accel_create(m.sys, &(hn_accel_opts){0}, m.arena, &accel), HN_OK);
        double q[LINKS], v[LINKS], a[LINKS];
        for (int i = 0; i < m.n; i++) {
            q[i] = 0.2 * i;
            v[i] = 1 - 0.1 * (i % 7);
        }
        hn_accel_info info;
        assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, NULL, &info), HN_OK);
        assert_int_equal(info.fallback, !unrolled);
        const double *M = term(&m, HN_TERM_M, 0, q, v), *f = term(&m, HN_TERM_F, 0, q, v);
        double scale = 0;
        for (int i = 0; i < m.n; i++) {
            scale = fmax(scale, fabs(f[i]));
        }
        for (int i = 0; i < m.n; i++) {
            double rest = -f[i];
            for (int k = 0; k < m.n; k++) {
                rest += M[i * m.n + k] * a[k];
            }
            assert_near(rest, 0,
                        1e-9 * scale); // the condition of a long chain's mass matrix is some 1e4
        }
        hn_accel_free(accel);
        close_model(&m);
        hn_strbuf_reset(&b);
    }
}

static void equations_that_would_grow_without_bound_are_refused(void **state) {
    (void)state;
    hn_strbuf b;
    hn_strbuf_init(&b);
    write_chain(&b, 1900);
    model m;
    hn_diags diags;
    assert_int_equal(compile_text(hn_strbuf_text(&b), &m, &diags), HN_ERR_LIMIT);
    assert_string_equal(diags.item[0].pointer, "/bodies");
    assert_non_null(strstr(diags.item[0].message, "mass entries"));
    hn_strbuf_reset(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loop_that_can_never_close_is_told_with_its_offset),
        cmocka_unit_test(a_freedom_without_mass_is_told),
        cmocka_unit_test(a_kinetic_energy_that_is_not_quadratic_is_refused),
        cmocka_unit_test(a_constraint_that_moves_with_time_has_all_its_derivatives),
        cmocka_unit_test(mass_that_depends_on_the_coordinates_gives_its_bias),
        cmocka_unit_test(a_torque_on_a_joint_works_on_that_joint_alone),
        cmocka_unit_test(a_force_at_a_point_works_on_the_points_velocity),
        cmocka_unit_test(a_spring_takes_what_its_energy_loses_and_its_damper_only_takes),
        cmocka_unit_test(a_spring_on_a_joint_pulls_to_its_rest),
        cmocka_unit_test(the_coordinate_of_a_cut_joint_follows_from_the_absolute_angles),
        cmocka_unit_test(a_bennett_linkage_moves_although_its_rows_outnumber_its_speeds),
        cmocka_unit_test(inspect_tells_the_tree_the_cut_and_exact_counts),
        cmocka_unit_test(
            a_ladder_of_200_loops_costs_as_much_a_loop_as_one_of_10_to_compile_and_to_evaluate),
        cmocka_unit_test(symbolic_parameters_change_nothing_in_the_numbers),
        cmocka_unit_test(a_matrix_that_is_not_sparse_is_not_unrolled),
        cmocka_unit_test(equations_that_would_grow_without_bound_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
