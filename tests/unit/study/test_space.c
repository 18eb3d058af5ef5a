// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms in space, drives and published problems, as shipped: what closed forms and other
// people's figures say of them.
#include "support/motion.h"
#include "support/near.h"
#include "support/trial.h"

#include "dynamics/compile/compile.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/svd.h"

#include <gsl/gsl_sf_ellint.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define SCENE(name) "lessons/09-space-and-drives/scenes/" name ".json"
static const double PI = 3.14159265358979323846;

static void open_scene(hn_trial *trial, const char *name, const hn_setting *settings, int n) {
    char path[128];
    snprintf(path, sizeof path, SCENE("%s"), name);
    hn_trial_open_with(trial, path, settings, n);
}

/// p turned by the rotation vector r (Rodrigues).
static void turn(const double r[3], const double p[3], double out[3]) {
    double a = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), dot = 0;
    double k[3] = {r[0] / a, r[1] / a, r[2] / a};
    double cross[3] = {k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2],
                       k[0] * p[1] - k[1] * p[0]};
    for (int i = 0; i < 3; i++) {
        dot += k[i] * p[i];
    }
    for (int i = 0; i < 3; i++) {
        out[i] = p[i] * cos(a) + cross[i] * sin(a) + k[i] * dot * (1 - cos(a));
    }
}

static void freedoms_and_rank_are_those_of_the_books(void **state) {
    (void)state;
    static const hn_trial_count known[] = {
        {SCENE("spinning-block"), 6, 0, 0},       {SCENE("heavy-top"), 3, 0, 0},
        {SCENE("spatial-slider-crank"), 1, 3, 3}, {SCENE("cardan-shaft"), 1, 3, 4},
        {SCENE("oblique-four-bar"), 1, 2, 2},     {SCENE("car-axis"), 2, 2, 2},
        {SCENE("seven-body-squeezer"), 1, 6, 6},  {SCENE("stewart-6-6"), 6, 18, 18},
        {SCENE("stewart-6-3"), 6, 18, 18},        {SCENE("delta-robot"), 3, 6, 6},
        {SCENE("driven-crank"), 1, 3, 3},         {SCENE("planetary-gear"), 1, 4, 6},
        {SCENE("rolling-wheel"), 2, 2, 2},        {SCENE("rssr"), 2, 3, 3},
    };
    hn_trial_check_counts(known, sizeof known / sizeof known[0]);
}

// x^2 = l^2 - y^2 - z^2 with (y, z) the tip of the crank
static void the_spatial_slider_stands_where_its_rod_reaches(void **state) {
    (void)state;
    hn_trial trial;
    open_scene(&trial, "spatial-slider-crank", NULL, 0);
    const int th = hn_trial_coordinate(&trial, "th"), x = hn_trial_coordinate(&trial, "x");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    for (int k = 1; k <= 100; k++) {
        const hn_sample s = hn_motion_at(run, 0.02 * k);
        double y = 0.12 + 0.08 * cos(s.q[th]), z = -0.1 + 0.08 * sin(s.q[th]);
        assert_near(s.q[x], sqrt(0.09 - y * y - z * z), 1e-13); // gaps of rounding
        assert_near(s.energy_change, 0, 1e-7);                  // of 0.8 J, by RK4 at 28 rad/s
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

// d^2 + a^2 + c^2 + e^2 - b^2 - 2 d a cos th - 2 e c sin ps - 2 a c sin th cos ps = 0, and the spin
// about the coupler's axis, its own and what the crank adds, stays: balls on the axis of a round
// bar give no moment about it
static void an_rssr_linkage_closes_and_its_coupler_keeps_its_spin(void **state) {
    (void)state;
    const hn_setting spin = {"s", 10};
    const double a = 0.2, b = 1.1, c = 0.5, d = 0.8, e = 0.6;
    hn_trial trial;
    open_scene(&trial, "rssr", &spin, 1);
    const int th = hn_trial_coordinate(&trial, "th"), ps = hn_trial_coordinate(&trial, "ps"),
              r = hn_trial_coordinate(&trial, "rx"), wx = hn_trial_coordinate(&trial, "wx");
    hn_run *run = hn_trial_run(&trial, "projection@dop853:rtol=1e-10");
    double first = 0;
    for (int k = 0; k <= 50; k++) {
        const hn_sample s = hn_motion_at(run, 0.02 * k);
        const double loop = d * d + a * a + c * c + e * e - b * b - 2 * d * a * cos(s.q[th]) -
                            2 * e * c * sin(s.q[ps]) - 2 * a * c * sin(s.q[th]) * cos(s.q[ps]);
        assert_near(loop, 0, 1e-9); // samples between steps are interpolated
        const double axis[3] = {1, 0, 0};
        double in_crank[3];
        turn(s.q + r, axis, in_crank);
        const double total = s.v[wx] + s.v[th] * in_crank[2];
        first = k == 0 ? total : first;
        assert_near(total, first, 1e-6);
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

// forks in one plane: even; turned by a right angle: from cos^2 be to 1/cos^2 be, both twice a turn
static void a_cardan_shaft_undoes_or_doubles_its_unevenness(void **state) {
    (void)state;
    for (int crossed = 0; crossed <= 1; crossed++) {
        const hn_setting twist = {"twist", crossed ? PI / 2 : 0};
        hn_trial trial;
        open_scene(&trial, "cardan-shaft", &twist, 1);
        const int th1 = hn_trial_coordinate(&trial, "th1"),
                  th3 = hn_trial_coordinate(&trial, "th3");
        hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
        double least = HUGE_VAL, most = 0;
        for (int k = 1; k <= 2000; k++) {
            const hn_sample s = hn_motion_at(run, 1e-3 * k);
            least = fmin(least, s.v[th3] / s.v[th1]);
            most = fmax(most, s.v[th3] / s.v[th1]);
            if (!crossed) {
                assert_near(s.q[th3], s.q[th1], 1e-12);
            }
        }
        const double c2 = cos(0.6) * cos(0.6);
        // an extreme is met within half a step, 0.005 rad, of a parabola
        assert_near(least, crossed ? c2 : 1, 1e-4);
        assert_near(most, crossed ? 1 / c2 : 1, 1e-4);
        hn_run_free(run);
        hn_trial_close(&trial);
    }
}

// A W^2 cos - C s W + m g l = 0 about the foot (Lagrange)
static void a_heavy_top_precesses_steadily_at_the_lower_root(void **state) {
    (void)state;
    const hn_setting steady = {"p", 1};
    const double C = 0.0025, A = 0.00625, s0 = 120, mgl = 0.5 * 9.81 * 0.1, tilt = 0.6;
    const double W =
        (C * s0 - sqrt(C * C * s0 * s0 - 4 * A * mgl * cos(tilt))) / (2 * A * cos(tilt));
    hn_trial trial;
    open_scene(&trial, "heavy-top", &steady, 1);
    hn_run *run = hn_trial_run(&trial, "index1@dop853:rtol=1e-11");
    assert_int_equal(hn_trial_coordinate(&trial, "rx"), 0);
    for (int k = 1; k <= 20; k++) {
        const hn_sample s = hn_motion_at(run, 0.05 * k);
        const double stem[3] = {0, 1, 0};
        double tip[3];
        turn(s.q, stem, tip);
        assert_near(tip[1], cos(tilt), 1e-9);
        assert_near(remainder(atan2(-tip[2], tip[0]) - W * s.t, 2 * PI), 0, 1e-8);
        assert_near(s.v[1], s0, 1e-9);
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

// Without precession the foot's top nods, and the angular momentum about the vertical and about the
// stem stay.
static void a_heavy_top_let_go_nods_between_two_heights(void **state) {
    (void)state;
    hn_trial trial;
    open_scene(&trial, "heavy-top", NULL, 0);
    hn_run *run = hn_trial_run(&trial, "index1@dop853:rtol=1e-11");
    const double stem[3] = {0, 1, 0}, A = 0.00625, C = 0.0025;
    double low = 1, high = -1;
    for (int k = 1; k <= 400; k++) {
        const hn_sample s = hn_motion_at(run, 1e-3 * k);
        double tip[3], momentum[3] = {A * s.v[0], C * s.v[1], A * s.v[2]}, in_space[3];
        turn(s.q, stem, tip);
        turn(s.q, momentum, in_space);
        low = fmin(low, tip[1]);
        high = fmax(high, tip[1]);
        assert_near(in_space[1], C * 120 * cos(0.6), 1e-11);
    }
    // the lower turning point u of (A W')^2 ...: A (1 - u^2) m g l 2 (u0 - u) = (C s)^2 (u0 - u)^2
    const double u0 = cos(0.6), mgl = 0.4905, b = C * C * 120 * 120 / (2 * A * mgl);
    const double u = b / 2 - sqrt(b * b / 4 - b * u0 + 1);
    assert_near(high, u0, 1e-5); // nearest sample to a smooth end
    assert_near(low, u, 1e-5);
    hn_run_free(run);
    hn_trial_close(&trial);
}

// Euler's free body (Landau and Lifshitz, section 37): between two zeros of wy, 2 K(k)/p
static void a_spinning_block_turns_over_as_an_elliptic_function(void **state) {
    (void)state;
    hn_trial trial;
    open_scene(&trial, "spinning-block", NULL, 0);
    const double I1 = 0.1 / 12, I2 = 0.37 / 12, I3 = 0.45 / 12;
    const double w1 = 0.05, w2 = 5, w3 = 0.05;
    const double E2 = I1 * w1 * w1 + I2 * w2 * w2 + I3 * w3 * w3;
    const double L2 = I1 * I1 * w1 * w1 + I2 * I2 * w2 * w2 + I3 * I3 * w3 * w3;
    assert_true(L2 > E2 * I2); // round the axis of the largest moment
    const double p = sqrt((I3 - I2) * (L2 - E2 * I1) / (I1 * I2 * I3));
    const double k2 = (I2 - I1) * (E2 * I3 - L2) / ((I3 - I2) * (L2 - E2 * I1));
    const double half = 2 * gsl_sf_ellint_Kcomp(sqrt(k2), GSL_PREC_DOUBLE) / p;
    const int wy = hn_trial_coordinate(&trial, "wy");
    hn_run *run = hn_trial_run(&trial, "index1@dop853:rtol=1e-12");
    double crossed[8], before = 5;
    int n = 0;
    for (int k = 1; k <= 20000 && n < 5; k++) {
        const hn_sample s = hn_motion_at(run, 1e-3 * k);
        if (s.v[wy] * before < 0) {
            crossed[n++] = s.t - 1e-3 * s.v[wy] / (s.v[wy] - before);
        }
        before = s.v[wy];
    }
    assert_int_equal(n, 5);
    for (int i = 1; i < 5; i++) {
        assert_near(crossed[i] - crossed[i - 1], half,
                    1e-6); // a chord of 1 ms of a sine-like curve
    }
    assert_near(crossed[0], 2.244, 1e-3); // as the scene says: 2.24 s, then every 3.73 s
    assert_near(half, 3.728, 1e-3);
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void an_oblique_four_bar_without_gravity_moves_as_one_in_the_plane(void **state) {
    (void)state;
    const hn_setting flat[] = {{"al", 0}, {"be", 0}, {"g", 0}},
                     oblique[] = {{"al", 0.9}, {"be", -1.1}, {"g", 0}};
    hn_trial one, two;
    open_scene(&one, "oblique-four-bar", flat, 3);
    open_scene(&two, "oblique-four-bar", oblique, 3);
    hn_run *a = hn_trial_run(&one, "projection@rk4:h=1e-3"),
           *b = hn_trial_run(&two, "projection@rk4:h=1e-3");
    for (int k = 1; k <= 20; k++) {
        const hn_sample s = hn_motion_at(a, 0.1 * k), r = hn_motion_at(b, 0.1 * k);
        for (int i = 0; i < one.info.n_user; i++) {
            assert_near(s.q[i], r.q[i], 1e-11); // rounding grown over 2000 steps
            assert_near(s.v[i], r.v[i], 1e-10);
        }
    }
    hn_run_free(a);
    hn_run_free(b);
    hn_trial_close(&one);
    hn_trial_close(&two);
}

static void the_car_axis_ends_where_the_test_set_says(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double value;
    } end[] = {{"xl", 0.0493455784275402819938},
               {"yl", 0.496989460230171153861},
               {"xr", 1.04174252488542151681},
               {"yr", 0.373911027265361256927}};
    hn_trial trial;
    open_scene(&trial, "car-axis", NULL, 0);
    hn_run *run = hn_trial_run(&trial, "projection@dop853:rtol=1e-12");
    const hn_sample s = hn_motion_at(run, 3);
    for (int i = 0; i < 4; i++) {
        assert_near(s.q[hn_trial_coordinate(&trial, end[i].name)], end[i].value,
                    1e-10); // 1e-12 times 50
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void the_squeezer_has_twelve_digits_at_its_end(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double value;
    } end[] = {{"beta", 15.8107711951537},    {"Theta", -15.7563710584118},
               {"gamma", 0.0408222401196458}, {"Phi", -0.534730116342080},
               {"delta", 0.524409965879954},  {"Omega", 0.534730116342080},
               {"epsilon", 1.04808074104194}};
    hn_trial trial;
    open_scene(&trial, "seven-body-squeezer", NULL, 0);
    hn_run *run = hn_trial_run(&trial, "projection@dop853:rtol=1e-12");
    const hn_sample s = hn_motion_at(run, 0.03);
    for (int i = 0; i < 7; i++) {
        const double size = fmax(1, fabs(end[i].value));
        assert_near(s.q[hn_trial_coordinate(&trial, end[i].name)] / size, end[i].value / size,
                    1e-12);
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

// ---- robots ----

/// The largest distance of a platform from its circle of radius rc, and of its height from h, from
/// t = 1 on.
static void follow_circle(const char *scene, double w, double h, const char *const names[3],
                          double *off, double *low) {
    hn_trial trial;
    open_scene(&trial, scene, NULL, 0);
    const int x = hn_trial_coordinate(&trial, names[0]), y = hn_trial_coordinate(&trial, names[1]),
              z = hn_trial_coordinate(&trial, names[2]);
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    *off = *low = 0;
    for (int k = 50; k <= 200; k++) {
        const hn_sample s = hn_motion_at(run, 0.02 * k);
        *off = fmax(*off, hypot(s.q[x] - 0.1 * cos(w * s.t), s.q[z] - 0.1 * sin(w * s.t)));
        *low = fmax(*low, fabs(s.q[y] - h));
        assert_true(s.gap < 1e-13);
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void platforms_follow_their_circles_as_closely_as_told(void **state) {
    (void)state;
    static const char *const pose[] = {"X", "Y", "Z"}, *const place[] = {"x", "y", "z"};
    double off, low;
    follow_circle("stewart-6-6", 3, 0.7, pose, &off, &low);
    assert_true(off < 0.004 && low > 0.0019 && low < 0.0022);
    follow_circle("stewart-6-3", 3, 0.7, pose, &off, &low);
    assert_true(off < 0.002 && low > 0.0019 && low < 0.0022);
    follow_circle("delta-robot", 5, -0.5, place, &off, &low);
    assert_true(off < 0.0004 && low > 0.0008 && low < 0.001);
}

static void platforms_without_gains_fall_and_keep_their_energy(void **state) {
    (void)state;
    static const char *const scenes[] = {"stewart-6-6", "stewart-6-3", "delta-robot"},
                             *const height[] = {"Y", "Y", "y"};
    const hn_setting loose[] = {{"kp", 0}, {"kd", 0}};
    for (int i = 0; i < 3; i++) {
        hn_trial trial;
        open_scene(&trial, scenes[i], loose, 2);
        const int y = hn_trial_coordinate(&trial, height[i]);
        hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
        const double y0 = hn_motion_at(run, 0).q[y];
        const hn_sample s = hn_motion_at(run, 0.1);
        // legs that fall along change little of g t^2 / 2
        assert_near(y0 - s.q[y], 9.81 * 0.01 / 2, 0.01);
        assert_near(hn_motion_at(run, 0.3).energy_change, 0, 1e-5); // of 100 J, by RK4
        hn_run_free(run);
        hn_trial_close(&trial);
    }
}

// three parallelograms forbid every rotation, in flight as under the drives
static void a_delta_platform_does_not_turn(void **state) {
    (void)state;
    for (int loose = 0; loose <= 1; loose++) {
        const hn_setting gains[] = {{"kp", 0}, {"kd", 0}};
        hn_trial trial;
        open_scene(&trial, "delta-robot", gains, loose ? 2 : 0);
        const int turns[] = {hn_trial_coordinate(&trial, "rx"), hn_trial_coordinate(&trial, "ry"),
                             hn_trial_coordinate(&trial, "rz")};
        const int x = hn_trial_coordinate(&trial, "x"), y = hn_trial_coordinate(&trial, "y");
        hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
        double way = 0;
        for (int k = 1; k <= 50; k++) {
            const hn_sample s = hn_motion_at(run, 0.02 * k);
            way = fmax(way, hypot(s.q[x] - 0.1, s.q[y] + 0.5));
            for (int i = 0; i < 3; i++) {
                assert_near(s.q[turns[i]], 0, 1e-12);
            }
        }
        assert_true(way > 0.1); // it did move
        hn_run_free(run);
        hn_trial_close(&trial);
    }
}

/// Least singular value of the six rods' rows at a yaw [degrees], rows per metre of the platform's
/// six speeds.
static double rods_sigma(double degrees) {
    const hn_setting yaw = {"yaw", degrees * PI / 180};
    hn_scene *scene;
    hn_system *sys;
    hn_diags diags = {0};
    hn_eval *eval;
    double sigma[6], q[8], v[8] = {0};
    assert_int_equal(hn_scene_load_file("tests/scenes/stewart-rods.json", &yaw, 1, &scene, &diags),
                     HN_OK);
    assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_OK);
    hn_arena *arena = hn_arena_create(0);
    hn_assembly report;
    assert_int_equal(hn_assemble(sys, 0, q, v, NULL, NULL, &report, &diags), HN_OK);
    assert_int_equal(hn_eval_create(sys, HN_TERM_J, arena, &eval), HN_OK);
    hn_eval_run(eval, 0, q, v);
    assert_int_equal(hn_singular_values(6, 6, hn_eval_get(eval, HN_TERM_J), sigma, arena), HN_OK);
    assert_int_equal(report.rank, degrees == 90 ? 5 : 6);
    hn_eval_free(eval);
    hn_arena_free(arena);
    hn_system_free(sys);
    hn_scene_free(scene);
    return sigma[5];
}

// Fichter 1986: half-angles of 15 and 45 degrees lose rank at a yaw of 90 degrees, linearly in the
// angle
static void a_platform_on_six_rods_comes_loose_at_a_yaw_of_ninety_degrees(void **state) {
    (void)state;
    const double s60 = rods_sigma(60), s89 = rods_sigma(89), close = rods_sigma(89.9);
    assert_true(rods_sigma(0) > s60 && s60 > 10 * s89);
    assert_near(close / s89, 0.1, 0.001); // curvature over one degree
    assert_true(rods_sigma(90) < 1e-14);
}

// ---- drives, wheels, teeth ----

// what the energy gains is the drive's work less what friction takes (Simpson's rule over samples)
static void the_torque_of_a_given_motion_does_the_work_that_the_energy_gains(void **state) {
    (void)state;
    enum { N = 2000 };
    const double w = 3, friction = 0.02, h = 1e-3;
    hn_trial trial;
    open_scene(&trial, "driven-crank", NULL, 0);
    const int th1 = hn_trial_coordinate(&trial, "th1"), wp = hn_trial_coordinate(&trial, "wp");
    const int drive = trial.info.nc - 1;
    assert_string_equal(hn_system_row_name(trial.sys, drive), "drive");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=5e-4");
    double work = 0;
    for (int k = 0; k <= N; k++) {
        const hn_sample s = hn_motion_at(run, h * k);
        const double weight = h / 3 * (k == 0 || k == N ? 1 : k % 2 ? 4 : 2);
        work += weight * (s.lambda[drive] * w - friction * s.v[wp] * s.v[wp]);
        assert_near(s.q[th1], w * s.t, 1e-13);
        if (k == N) {
            assert_true(fabs(s.work) > 0.1);
            assert_near(s.work, work, 1e-8);       // h^4
            assert_near(s.energy_change, 0, 1e-9); // the method's own error
        }
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

// one freedom: I ws' = T(t) - b n^2 ws, n = rs/(rs + rr), with T from 0 to T0 in half a second,
// then constant
static void a_planetary_gear_turns_as_its_table_of_torque_says(void **state) {
    (void)state;
    const double rs = 0.2, rp = 0.15, rr = 0.5, ms = 1, mp = 0.5, Ic = 0.05, T0 = 2, b = 1;
    const double n = rs / (rs + rr), spin = n * (1 - rr / rp); // of a planet, in space
    const double I = ms * rs * rs / 2 + (Ic + 3 * mp * (rs + rp) * (rs + rp)) * n * n +
                     3 * mp * rp * rp / 2 * spin * spin;
    const double c = b * n * n / I;
    hn_trial trial;
    open_scene(&trial, "planetary-gear", NULL, 0);
    const int ws = hn_trial_coordinate(&trial, "ws"), wc = hn_trial_coordinate(&trial, "wc");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    hn_sample s = hn_motion_at(run, 0.5);
    const double first = T0 / (0.5 * I) * (0.5 / c - (1 - exp(-0.5 * c)) / (c * c));
    assert_near(s.v[ws], first, 1e-10); // (c h)^4
    assert_near(s.v[wc], n * s.v[ws], 1e-13);
    s = hn_motion_at(run, 1.5);
    assert_near(s.v[ws], T0 / (c * I) + (first - T0 / (c * I)) * exp(-c), 1e-10);
    assert_int_equal(s.rank, 4);
    hn_run_free(run);
    hn_trial_close(&trial);
}

// at rest with the pendulum upright: a = (m + mp) g sin al / (m (1 + k) + mp sin^2 al), and all of
// it without slip
static void a_wheel_rolls_without_slip_and_starts_with_the_acceleration_of_theory(void **state) {
    (void)state;
    const double al = 0.168, R = 0.4, m = 2, mp = 1, g = 9.81;
    hn_trial trial;
    open_scene(&trial, "rolling-wheel", NULL, 0);
    const int x = hn_trial_coordinate(&trial, "x"), y = hn_trial_coordinate(&trial, "y"),
              th = hn_trial_coordinate(&trial, "th");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    hn_sample s = hn_motion_at(run, 0);
    assert_near(s.a[x] / cos(al), (m + mp) * g * sin(al) / (2 * m + mp * sin(al) * sin(al)), 1e-13);
    for (int k = 1; k <= 30; k++) {
        s = hn_motion_at(run, 0.1 * k);
        const double way = (s.q[x] - R * sin(al)) / cos(al);
        assert_near(way, -R * s.q[th], 1e-13); // right is clockwise
        assert_near(s.q[x] * sin(al) + s.q[y] * cos(al), R, 1e-14);
        assert_near(s.energy_change, 0, 1e-11); // of 60 J: smooth, by RK4
    }
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void every_setting_in_the_ranges_closes_the_loops(void **state) {
    (void)state;
    static const char *const scenes[] = {
        "spinning-block",   "heavy-top",   "spatial-slider-crank", "cardan-shaft",
        "oblique-four-bar", "car-axis",    "seven-body-squeezer",  "stewart-6-6",
        "stewart-6-3",      "delta-robot", "driven-crank",         "planetary-gear",
        "rolling-wheel",    "rssr"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        char path[128];
        snprintf(path, sizeof path, SCENE("%s"), scenes[i]);
        hn_trial_try_ranges(path);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(freedoms_and_rank_are_those_of_the_books),
        cmocka_unit_test(the_spatial_slider_stands_where_its_rod_reaches),
        cmocka_unit_test(an_rssr_linkage_closes_and_its_coupler_keeps_its_spin),
        cmocka_unit_test(a_cardan_shaft_undoes_or_doubles_its_unevenness),
        cmocka_unit_test(a_heavy_top_precesses_steadily_at_the_lower_root),
        cmocka_unit_test(a_heavy_top_let_go_nods_between_two_heights),
        cmocka_unit_test(a_spinning_block_turns_over_as_an_elliptic_function),
        cmocka_unit_test(an_oblique_four_bar_without_gravity_moves_as_one_in_the_plane),
        cmocka_unit_test(the_car_axis_ends_where_the_test_set_says),
        cmocka_unit_test(the_squeezer_has_twelve_digits_at_its_end),
        cmocka_unit_test(platforms_follow_their_circles_as_closely_as_told),
        cmocka_unit_test(platforms_without_gains_fall_and_keep_their_energy),
        cmocka_unit_test(a_delta_platform_does_not_turn),
        cmocka_unit_test(a_platform_on_six_rods_comes_loose_at_a_yaw_of_ninety_degrees),
        cmocka_unit_test(the_torque_of_a_given_motion_does_the_work_that_the_energy_gains),
        cmocka_unit_test(a_planetary_gear_turns_as_its_table_of_torque_says),
        cmocka_unit_test(a_wheel_rolls_without_slip_and_starts_with_the_acceleration_of_theory),
        cmocka_unit_test(every_setting_in_the_ranges_closes_the_loops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
