// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints beside the joints: derivatives of every kind, and motions and multipliers that are
// known without us.
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "support/mechanism.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define INERTIA "\"inertia\":{\"xx\":0.3,\"yy\":0.4,\"zz\":0.5}"
#define BODY(name) "{\"name\":\"" name "\",\"mass\":2,\"com\":[0.1,0.2,0]," INERTIA "}"
#define GROUND_TO(name) "\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"" name "\"}"

enum { MAX_N = 16 };

typedef struct probe {
    hn_model m;
    hn_eval *eval;
} probe;

static void begin(probe *p, const char *json) {
    hn_model_open_text(&p->m, json, NULL);
    assert_true(p->m.info.nq <= MAX_N && p->m.info.nc <= MAX_N);
    assert_int_equal(hn_eval_create(p->m.sys, (1u << HN_TERM_COUNT) - 1, p->m.arena, &p->eval),
                     HN_OK);
}

static void end(probe *p) {
    hn_eval_free(p->eval);
    hn_model_close(&p->m);
}

/// phi after the motion q moved by s v at t + s.
static void phi_after(probe *p, double t, const double *q, const double *v, double s, double *phi) {
    double at[MAX_N], way[MAX_N];
    memcpy(at, q, (size_t)p->m.info.nq * sizeof *q);
    for (int i = 0; i < p->m.info.nv; i++) {
        way[i] = s * v[i];
    }
    hn_system_move(p->m.sys, at, way);
    hn_eval_run(p->eval, t + s, at, v);
    memcpy(phi, hn_eval_get(p->eval, HN_TERM_PHI), (size_t)p->m.info.nc * sizeof *phi);
}

/// phi' = J v + phi_t, a term of its own too, and phi'' = gamma along a motion of constant v, by
/// five-point differences, at states where nothing is closed.
static void check_derivatives(const char *json, int rows) {
    const double h = 1e-3, t = 0.4;
    probe p;
    unsigned seed = 7;
    begin(&p, json);
    assert_int_equal(p.m.info.nc, rows);
    for (int trial = 0; trial < 10; trial++) {
        double user[MAX_N], q[MAX_N], v[MAX_N], phi[5][MAX_N];
        for (int i = 0; i < p.m.info.nv; i++) {
            user[i] = 1.5 * random_signed(&seed);
            v[i] = 2 * random_signed(&seed);
        }
        hn_system_from_user(p.m.sys, user, q);
        for (int k = 0; k < 5; k++) {
            phi_after(&p, t, q, v, (k - 2) * h, phi[k]);
        }
        hn_eval_run(p.eval, t, q, v);
        for (int i = 0; i < rows; i++) {
            double rate = hn_eval_get(p.eval, HN_TERM_PHI_T)[i];
            for (int j = 0; j < p.m.info.nv; j++) {
                rate += hn_eval_get(p.eval, HN_TERM_J)[i * p.m.info.nv + j] * v[j];
            }
            const double d1 = (phi[0][i] - 8 * phi[1][i] + 8 * phi[3][i] - phi[4][i]) / (12 * h);
            const double d2 =
                (-phi[0][i] + 16 * phi[1][i] - 30 * phi[2][i] + 16 * phi[3][i] - phi[4][i]) /
                (12 * h * h);
            const double gamma = hn_eval_get(p.eval, HN_TERM_GAMMA)[i];
            assert_near(rate, d1, 1e-9 * (1 + fabs(d1))); // h^4 and rounding / h
            assert_near(hn_eval_get(p.eval, HN_TERM_RATES)[i], rate, 1e-13 * (1 + fabs(rate)));
            assert_near(gamma, d2, 1e-7 * (1 + fabs(d2)));
        }
    }
    end(&p);
}

#define SPATIAL                                                                                    \
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[" BODY("a") "," BODY("b") "," BODY(                 \
        "c") "],"                                                                                  \
             "\"joints\":[{\"name\":\"F\",\"type\":\"free\"," GROUND_TO(                           \
                 "a") "},"                                                                         \
                      "{\"name\":\"R\",\"type\":\"revolute\"," GROUND_TO(                          \
                          "b") ",\"axis\":[1,2,2],"                                                \
                               "\"coordinate\":\"th\"},"                                           \
                               "{\"name\":\"P\",\"type\":\"prismatic\",\"parent\":{\"body\":"      \
                               "\"b\",\"at\":[0.3,0,0.1]},"                                        \
                               "\"child\":{\"body\":\"c\"},\"axis\":[0,1,1],\"coordinate\":\"x\"}" \
                               "],\"constraints\":["

#define P_ON_A "{\"body\":\"a\",\"at\":[0.2,-0.3,0.4]}"
#define Q_ON_C "{\"body\":\"c\",\"at\":[-0.5,0.1,0.6]}"

static void rows_between_points_are_differentiated_rightly_in_space(void **state) {
    (void)state;
    check_derivatives(
        SPATIAL "{\"distance\":{\"from\":" P_ON_A ",\"to\":" Q_ON_C ",\"length\":0.8}}]}", 1);
    check_derivatives(SPATIAL "{\"line\":{\"point\":" P_ON_A ",\"through\":" Q_ON_C
                              ",\"direction\":[1,2,-1]}}]}",
                      2);
    check_derivatives(SPATIAL "{\"plane\":{\"point\":" P_ON_A ",\"through\":" Q_ON_C
                              ",\"direction\":[1,2,-1],\"offset\":0.3}}]}",
                      1);
}

static void rows_between_coordinates_are_differentiated_rightly(void **state) {
    (void)state;
    check_derivatives(SPATIAL "{\"gear\":{\"coordinates\":[\"th\",\"x\"],\"ratio\":-2.5,"
                              "\"phase\":0.1}}]}",
                      1);
    check_derivatives(SPATIAL "{\"formula\":\"th^2*sin(x) - 0.3*t^2*th + F_y*x\"},"
                              "{\"motion\":{\"coordinate\":\"th\",\"value\":\"sin(3*t)\"}}]}",
                      2);
}

// a slider-crank cut at its slide: the slide's coordinate is known from the other joints only
static void a_formula_reaches_the_coordinate_of_a_cut_joint(void **state) {
    (void)state;
    check_derivatives("{\"holonom\":1,\"name\":\"x\",\"bodies\":[" BODY("a") "," BODY(
                          "b") "],"
                               "\"joints\":[{\"name\":\"A\",\"type\":\"revolute\"," GROUND_TO(
                                   "a") ",\"coordinate\":\"th\"},"
                                        "{\"name\":\"B\",\"type\":\"revolute\",\"parent\":{"
                                        "\"body\":\"a\",\"at\":[0.4,0.1]},"
                                        "\"child\":{\"body\":\"b\"}},"
                                        "{\"name\":\"S\",\"type\":\"prismatic\",\"cut\":true,"
                                        "\"parent\":{\"body\":\"b\"},"
                                        "\"child\":{\"body\":\"ground\"},\"axis\":[1,0.5,0],"
                                        "\"coordinate\":\"s\"}],"
                                        "\"constraints\":[{\"formula\":\"s*s - t*th + s\"}]}",
                      3);
}

#define WHEEL_ON_PLATE                                                                           \
    "{\"holonom\":1,\"name\":\"x\",\"bodies\":[" BODY("plate") "," BODY(                         \
        "wheel") "],"                                                                            \
                 "\"joints\":[{\"name\":\"T\",\"type\":\"revolute\"," GROUND_TO(                 \
                     "plate") ",\"coordinate\":\"tilt\"},"                                       \
                              "{\"name\":\"P\",\"type\":\"planar\"," GROUND_TO(                  \
                                  "wheel") "}],\"constraints\":[{\"rolling\":"                   \
                                           "{\"centre\":{\"body\":\"wheel\",\"at\":[0,0]},"      \
                                           "\"through\":{"                                       \
                                           "\"body\":\"plate\",\"at\":[0.1,0.2]},"               \
                                           "\"direction\":[4,3,0],\"up\":[-3,4,0],\"radius\":0." \
                                           "25}}]}"

static void rolling_on_a_line_that_turns_is_differentiated_rightly(void **state) {
    (void)state;
    check_derivatives(WHEEL_ON_PLATE, 2);
}

/// The touching point of the wheel and that of the plate have one velocity when the way row holds.
static void the_touching_point_of_a_rolling_wheel_does_not_slip(void **state) {
    (void)state;
    probe p;
    begin(&p, WHEEL_ON_PLATE);
    // admissible speeds: tilt at rest, wheel along the line at 0.5 m/s, turning by -v / r
    const double user_q[4] = {0, 0.1 + 0.8 * 0.4 - 0.6 * 0.25, 0.2 + 0.6 * 0.4 + 0.8 * 0.25, 1};
    const double user_v[4] = {0, 0.8 * 0.5, 0.6 * 0.5, -0.5 / 0.25};
    double q[MAX_N], v[MAX_N];
    hn_system_from_user(p.m.sys, user_q, q);
    hn_system_rates_from_user(p.m.sys, user_v, v);
    hn_eval_run(p.eval, 0, q, v);
    assert_near(hn_eval_get(p.eval, HN_TERM_PHI)[0], 0, 1e-15);
    for (int i = 0; i < 2; i++) {
        double rate = 0;
        for (int j = 0; j < 4; j++) {
            rate += hn_eval_get(p.eval, HN_TERM_J)[i * 4 + j] * v[j];
        }
        assert_near(rate, 0, 1e-15);
    }
    end(&p);
}

/// Accelerations and multipliers at the assembled state, user coordinates.
static void solve(probe *p, double t, double *a, double *lambda) {
    hn_accel *accel = NULL;
    hn_accel_info info;
    double own[MAX_N];
    assert_int_equal(
        hn_accel_create(p->m.sys, &(hn_accel_opts){.want_lambda = 1}, p->m.arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, t, p->m.q, p->m.v, 0, 0, own, lambda, &info), HN_OK);
    hn_system_rates_to_user(p->m.sys, own, a);
    hn_accel_free(accel);
}

static void a_disc_rolls_down_a_slope_with_two_thirds_of_g_sine(void **state) {
    (void)state;
    probe p;
    double a[MAX_N], lambda[MAX_N];
    begin(&p,
          "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81],\"bodies\":[{\"name\":\"disc\","
          "\"mass\":3,\"inertia\":{\"zz\":0.06}}],"
          "\"joints\":[{\"name\":\"P\",\"type\":\"planar\"," GROUND_TO(
              "disc") "}],"
                      "\"constraints\":[{\"name\":\"slope\",\"rolling\":{\"centre\":{\"body\":"
                      "\"disc\",\"at\":[0,0]},"
                      "\"through\":[0,0],\"direction\":[4,-3,0],\"up\":[3,4,0],\"radius\":0.2}}]}");
    solve(&p, 0, a, lambda);
    const double down = 9.81 * 0.6 * 2 / 3; // I = m r^2 / 2
    assert_near(a[0], 0.8 * down, 1e-13);
    assert_near(a[1], -0.6 * down, 1e-13);
    assert_near(a[2], -down / 0.2, 1e-12);
    assert_near(lambda[0], 3 * 9.81 * 0.8, 1e-12);      // carried by the slope
    assert_near(lambda[1], -3 * 9.81 * 0.6 / 3, 1e-12); // friction holds back a third
    end(&p);
}

static void a_rod_pulls_with_weight_and_centrifugal_force(void **state) {
    (void)state;
    probe p;
    double a[MAX_N], lambda[MAX_N];
    const double m = 2, l = 0.7, th = 0.5, w = 3, g = 9.81;
    char text[700];
    snprintf(text, sizeof text,
             "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81],\"bodies\":[{\"name\":\"bob\","
             "\"mass\":2,\"inertia\":{\"zz\":1}}],\"joints\":[{\"name\":\"P\",\"type\":"
             "\"planar\"," GROUND_TO(
                 "bob") "}],\"constraints\":[{\"name\":\"rod\",\"distance\":{\"from\":{\"body\":"
                        "\"bob\",\"at\":[0,0]},\"to\":[0,0],\"length\":0.7}}],"
                        "\"start\":{\"positions\":{\"P_x\":%.17g,\"P_y\":%.17g},\"rates\":{\"d_P_"
                        "x\":%.17g,\"d_P_y\":%.17g}}}",
             l * sin(th), -l * cos(th), l * w * cos(th), l * w * sin(th));
    begin(&p, text);
    solve(&p, 0, a, lambda);
    // J' lambda is the force on the bob along p - q: a pull is negative
    assert_near(lambda[0], -m * (g * cos(th) + l * w * w), 1e-12);
    assert_near(a[0], l * (-g / l * sin(th)) * cos(th) - l * w * w * sin(th), 1e-12);
    end(&p);
}

static void a_gear_shares_the_torque_by_its_ratio(void **state) {
    (void)state;
    probe p;
    double a[MAX_N], lambda[MAX_N];
    begin(&p, "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"a\",\"mass\":1,\"inertia\":"
              "{\"zz\":0.5}},{\"name\":\"b\",\"mass\":1,\"inertia\":{\"zz\":2}}],\"joints\":["
              "{\"name\":\"A\",\"type\":\"revolute\"," GROUND_TO(
                  "a") ",\"coordinate\":\"x\"},"
                       "{\"name\":\"B\",\"type\":\"revolute\"," GROUND_TO(
                           "b") ",\"coordinate\":\"y\"}],"
                                "\"loads\":[{\"torque\":{\"joint\":\"A\",\"value\":7}}],"
                                "\"constraints\":[{\"gear\":{\"coordinates\":[\"x\",\"y\"],"
                                "\"ratio\":3}}]}");
    solve(&p, 0, a, lambda);
    const double ay = -7.0 * 3 / (0.5 * 9 + 2); // x'' = -3 y'': (9 I_a + I_b) y'' = -3 tau
    assert_near(a[1], ay, 1e-14);
    assert_near(a[0], -3 * ay, 1e-14);
    assert_near(lambda[0], 2 * ay / 3, 1e-14); // I_b y'' = 3 lambda
    end(&p);
}

// a crank driven at constant speed, a wheel of inertia on it and a torque against it: lambda is the
// drive's torque
static void a_driven_crank_turns_as_told_and_its_multiplier_is_the_torque(void **state) {
    (void)state;
    probe p;
    double a[MAX_N], lambda[MAX_N];
    begin(&p, "{\"holonom\":1,\"name\":\"x\",\"gravity\":[0,-9.81],\"bodies\":[{\"name\":\"arm\","
              "\"mass\":2,\"com\":[0.5,0],\"inertia\":{\"zz\":0.1}}],\"joints\":[{\"name\":\"A\","
              "\"type\":\"revolute\"," GROUND_TO(
                  "arm") ",\"coordinate\":\"th\",\"rate\":\"w\"}],"
                         "\"loads\":[{\"torque\":{\"joint\":\"A\",\"value\":\"-0.3*w\"}}],"
                         "\"constraints\":[{\"name\":\"drive\",\"motion\":{\"joint\":\"A\","
                         "\"value\":\"2*t + t^2\"}}]}");
    solve(&p, 0, a, lambda);
    assert_near(p.m.user_q[0], 0, 1e-14);
    assert_near(p.m.user_v[0], 2, 1e-14);
    assert_near(a[0], 2, 1e-14);
    // (I + m c^2) a = lambda - m g c - 0.3 w
    assert_near(lambda[0], (0.1 + 2 * 0.25) * 2 + 2 * 9.81 * 0.5 + 0.3 * 2, 1e-13);
    assert_true(hn_system_get_info(p.m.sys).has_time);
    end(&p);
}

// a four-bar whose crank is driven at w: the other angles and their rates by the law of cosines,
// the drive's torque by its power
static void a_driven_four_bar_moves_as_its_closed_form(void **state) {
    (void)state;
    const double l1 = 0.3, l2 = 0.9, l3 = 0.7, d = 1.0, w = 4, t = 0.37;
    probe p;
    double a[MAX_N], lambda[MAX_N], user[3], speed[3], q[MAX_N], v[MAX_N], x[3];
    begin(&p,
          "{\"holonom\":1,\"name\":\"x\",\"bodies\":[{\"name\":\"crank\",\"mass\":1,"
          "\"inertia\":{\"zz\":0.1}},{\"name\":\"coupler\",\"mass\":2,\"com\":[0.4,0],"
          "\"inertia\":{\"zz\":0.2}},{\"name\":\"rocker\",\"mass\":1,\"inertia\":{\"zz\":0.3}}],"
          "\"joints\":[{\"name\":\"A\",\"type\":\"revolute\"," GROUND_TO(
              "crank") ",\"coordinate\":"
                       "\"a\"},{\"name\":\"B\",\"type\":\"revolute\",\"parent\":{\"body\":"
                       "\"crank\",\"at\":"
                       "[0.3,0]},\"child\":{\"body\":\"coupler\"},\"coordinate\":\"b\"},{\"name\":"
                       "\"D\",\"type\":"
                       "\"revolute\",\"parent\":{\"body\":\"ground\",\"at\":[1,0]},\"child\":{"
                       "\"body\":\"rocker\"},"
                       "\"coordinate\":\"c\"},{\"name\":\"C\",\"type\":\"revolute\",\"cut\":true,"
                       "\"parent\":{"
                       "\"body\":\"coupler\",\"at\":[0.9,0]},\"child\":{\"body\":\"rocker\",\"at\":"
                       "[0.7,0]}}],"
                       "\"constraints\":[{\"name\":\"drive\",\"motion\":{\"joint\":\"A\",\"value\":"
                       "\"4*t\"}}],"
                       "\"start\":{\"positions\":{\"b\":{\"guess\":0.8},\"c\":{\"guess\":1.6}}}}");
    double angle[5][3]; // crank, coupler, rocker, absolute, 1 ms apart
    for (int k = 0; k < 5; k++) {
        const double th = w * (t + (k - 2) * 1e-3), bx = l1 * cos(th), by = l1 * sin(th);
        const double r = hypot(d - bx, by), to_d = atan2(-by, d - bx);
        angle[k][0] = th;
        angle[k][1] = to_d + acos((r * r + l2 * l2 - l3 * l3) / (2 * r * l2));
        angle[k][2] = atan2(by + l2 * sin(angle[k][1]), bx + l2 * cos(angle[k][1]) - d);
    }
    const double h = 1e-3;
    double rate[3], second[3];
    for (int i = 0; i < 3; i++) {
        rate[i] = (angle[0][i] - 8 * angle[1][i] + 8 * angle[3][i] - angle[4][i]) / (12 * h);
        second[i] =
            (-angle[0][i] + 16 * angle[1][i] - 30 * angle[2][i] + 16 * angle[3][i] - angle[4][i]) /
            (12 * h * h);
        user[i] = angle[2][i] - (i == 1 ? angle[2][0] : 0);
        speed[i] = rate[i] - (i == 1 ? rate[0] : 0);
    }
    hn_system_from_user(p.m.sys, user, q);
    hn_system_rates_from_user(p.m.sys, speed, v);
    hn_eval_run(p.eval, t, q, v);
    for (int i = 0; i < p.m.info.nc; i++) {
        assert_near(hn_eval_get(p.eval, HN_TERM_PHI)[i], 0, 1e-14);
    }
    memcpy(p.m.q, q, (size_t)p.m.info.nq * sizeof *q);
    memcpy(p.m.v, v, (size_t)p.m.info.nv * sizeof *v);
    solve(&p, t, a, lambda);
    x[0] = second[0];
    x[1] = second[1] - second[0];
    x[2] = second[2];
    assert_all_near(a, x, 3, 1e-7); // rounding / h^2
    // the drive's power is the change of the kinetic energy: coupler's centre 0.4 m from B
    const double sb = sin(angle[2][1]), cb = cos(angle[2][1]), sa = sin(angle[2][0]),
                 ca = cos(angle[2][0]);
    const double vx = -l1 * w * sa - 0.4 * rate[1] * sb, vy = l1 * w * ca + 0.4 * rate[1] * cb;
    const double ax = -l1 * w * w * ca - 0.4 * (second[1] * sb + rate[1] * rate[1] * cb);
    const double ay = -l1 * w * w * sa + 0.4 * (second[1] * cb - rate[1] * rate[1] * sb);
    const double power =
        2 * (vx * ax + vy * ay) + 0.2 * rate[1] * second[1] + 0.3 * rate[2] * second[2];
    int drive = -1;
    for (int i = 0; i < p.m.info.nc; i++) {
        drive = strcmp(hn_system_row_name(p.m.sys, i), "drive") == 0 ? i : drive;
    }
    assert_near(lambda[drive] * w, power, 1e-6);
    end(&p);
}

static void every_constraint_is_a_loop_and_one_with_points_has_a_tear(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m,
                       SPATIAL "{\"name\":\"rod\",\"distance\":{\"from\":" P_ON_A ",\"to\":" Q_ON_C
                               ",\"length\":0.8}},{\"name\":\"wheels\",\"gear\":{\"coordinates\":"
                               "[\"th\",\"x\"],\"ratio\":2}}]}",
                       NULL);
    const hn_drawing d = hn_system_drawing(m.sys);
    assert_int_equal(m.info.n_loops, 2);
    assert_string_equal(hn_system_loop_name(m.sys, 0), "rod");
    assert_string_equal(hn_system_loop_name(m.sys, 1), "wheels");
    assert_int_equal(hn_system_loop_joint(m.sys, 0), -1);
    assert_string_equal(hn_system_row_name(m.sys, 0), "rod: distance");
    assert_string_equal(hn_system_row_name(m.sys, 1), "wheels");
    assert_int_equal(d.n_tears, 1);
    assert_string_equal(d.tear_names[0], "rod");
    // half as long again: the point where the rod should end lies on the line, at its length from
    // the other end
    hn_eval *e = NULL;
    double user[MAX_N] = {1, 2, 3, 0.1, 0.2, 0.3, 0.4, 0.5}, q[MAX_N], from[3] = {0, 0, 0};
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_POINTS | HN_TERM_PHI, m.arena, &e), HN_OK);
    hn_system_from_user(m.sys, user, q);
    hn_eval_run(e, 0, q, NULL);
    const double *x = hn_eval_get(e, HN_TERM_POINTS);
    double gap = 0, length = 0;
    for (int i = 0; i < 3; i++) {
        from[i] = x[3 * m.scene->constraints[0].q + i];
        gap += pow(x[3 * d.tears[0][0] + i] - x[3 * d.tears[0][1] + i], 2);
        length += pow(x[3 * d.tears[0][1] + i] - from[i], 2);
    }
    assert_near(sqrt(length), 0.8, 1e-14);
    // phi = (D^2 - L^2) / (2 L) with D = L + gap
    assert_near(hn_eval_get(e, HN_TERM_PHI)[0], sqrt(gap) * (1 + sqrt(gap) / 1.6), 1e-13);
    hn_eval_free(e);
    hn_model_close(&m);
}

static void a_wheel_whose_axle_tilts_is_refused_with_the_reason(void **state) {
    (void)state;
    static const char text[] = "{\"holonom\":1,\"name\":\"x\",\"bodies\":[" BODY(
        "wheel") "],"
                 "\"joints\":[{\"name\":\"F\",\"type\":\"free\"," GROUND_TO(
                     "wheel") "}],\"constraints\":["
                              "{\"name\":\"track\",\"rolling\":{\"centre\":{\"body\":\"wheel\","
                              "\"at\":[0,0]},"
                              "\"through\":[0,0],"
                              "\"direction\":[1,0,0],\"up\":[0,1,0],\"radius\":0.25}}]}";
    hn_scene *scene = NULL;
    hn_system *sys = NULL;
    hn_diags diags = {0};
    assert_int_equal(hn_scene_load_json(text, sizeof text - 1, NULL, NULL, 0, &scene, &diags),
                     HN_OK);
    assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_ERR_UNSUPPORTED);
    assert_non_null(strstr(diags.item[0].message, "'track' cannot roll"));
    hn_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_between_points_are_differentiated_rightly_in_space),
        cmocka_unit_test(rows_between_coordinates_are_differentiated_rightly),
        cmocka_unit_test(a_formula_reaches_the_coordinate_of_a_cut_joint),
        cmocka_unit_test(rolling_on_a_line_that_turns_is_differentiated_rightly),
        cmocka_unit_test(the_touching_point_of_a_rolling_wheel_does_not_slip),
        cmocka_unit_test(a_disc_rolls_down_a_slope_with_two_thirds_of_g_sine),
        cmocka_unit_test(a_rod_pulls_with_weight_and_centrifugal_force),
        cmocka_unit_test(a_gear_shares_the_torque_by_its_ratio),
        cmocka_unit_test(a_driven_crank_turns_as_told_and_its_multiplier_is_the_torque),
        cmocka_unit_test(a_driven_four_bar_moves_as_its_closed_form),
        cmocka_unit_test(every_constraint_is_a_loop_and_one_with_points_has_a_tear),
        cmocka_unit_test(a_wheel_whose_axle_tilts_is_refused_with_the_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
