// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs against trusted numbers: the reference four-bar at t = 1 and 2, found by two
// independent computations that share 13 digits, and the N-four-bar, whose motion is known in
// closed form.

#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

typedef struct golden {
    double t, th1, th2, th3, w1, lambda[2];
} golden;

// angles and rate: one-coordinate equation by extrapolation in 30-digit arithmetic, all digits
// shown agree for two step sizes;
// multipliers: 13 digits
static const golden REFERENCE[] = {
    {1,
     2.72677524435372249,
     0.434120794394454479,
     2.37837623328492433,
     4.16807616253487913,
     {-0.87024247816248, -4.59980302488838}},
    {2,
     7.41136679869211579,
     0.464690378889553311,
     1.56178258771354034,
     1.57149060850687302,
     {-0.4306137880871, 6.9445833305829}},
};
static const double ENERGY = 49.34675722838445;

/// Rates of coupler and rocker for a crank rate, from the closed loop by Cramer's rule (l = 1, 2,
/// 1.8).
static void other_rates(const golden *g, double *w2, double *w3) {
    double det = 2 * sin(g->th2 - g->th3);
    *w2 = -sin(g->th1 - g->th3) * g->w1 / det;
    *w3 = -2 * sin(g->th1 - g->th2) * g->w1 / (1.8 * det);
}

/// Absolute angles and rates of crank, coupler, rocker, whichever coordinates the scene uses.
static void read_angles(const hn_model *m, const hn_sample *s, double angle[3], double rate[3]) {
    int i1 = hn_model_user(m, "th1"), i3 = hn_model_user(m, "th3");
    int relative = hn_scene_find_coordinate(m->scene, "a2") >= 0;
    int i2 = hn_model_user(m, relative ? "a2" : "th2");
    angle[0] = s->q[i1];
    angle[1] = s->q[i2] + (relative ? s->q[i1] : 0);
    angle[2] = s->q[i3];
    rate[0] = s->v[i1];
    rate[1] = s->v[i2] + (relative ? s->v[i1] : 0);
    rate[2] = s->v[i3];
}

static void must_meet_reference(const char *scene, const char *method, double tol) {
    hn_model m;
    hn_model_open_closed(&m, scene, NULL);
    hn_run *run = hn_motion_start(&m, method);
    for (size_t k = 0; k < 2; k++) {
        const golden *g = &REFERENCE[k];
        hn_sample s = hn_motion_at(run, g->t);
        double angle[3], rate[3], w2, w3;
        read_angles(&m, &s, angle, rate);
        other_rates(g, &w2, &w3);
        assert_near(angle[0], g->th1, tol * fmax(1, g->th1));
        assert_near(angle[1], g->th2, tol);
        assert_near(angle[2], g->th3, tol * g->th3);
        assert_near(rate[0], g->w1, tol * g->w1);
        assert_near(rate[1], w2, tol * fmax(1, fabs(w2)));
        assert_near(rate[2], w3, tol * fmax(1, fabs(w3)));
        assert_near(s.lambda[0], g->lambda[0], 5 * tol); // |d lambda| is a few times |d state|
        assert_near(s.lambda[1], g->lambda[1], 5 * tol);
        assert_near(s.energy, ENERGY, 10 * tol);
    }
    hn_run_free(run);
    hn_model_close(&m);
}

static void the_reference_closes_the_loop(void **state) {
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        const golden *g = &REFERENCE[k];
        assert_near(cos(g->th1) + 2 * cos(g->th2) - 1.8 * cos(g->th3), 2.2, 1e-15 * 4);
        assert_near(sin(g->th1) + 2 * sin(g->th2) - 1.8 * sin(g->th3), 0, 1e-15 * 4);
    }
}

static void projection_meets_the_reference_to_twelve_digits(void **state) {
    (void)state;
    must_meet_reference("fb0", "projection@rk4:h=1e-4", 1e-12);
    must_meet_reference("fb0-lagrangian", "projection@rk4:h=1e-4", 1e-12);
}

static void reduced_coordinates_meet_the_reference_to_twelve_digits(void **state) {
    (void)state;
    must_meet_reference("fb0", "reduced@rk4:h=1e-4", 1e-12);
    must_meet_reference("fb0-lagrangian", "reduced@rk4:h=1e-4", 1e-12);
}

static void every_sound_formulation_meets_the_reference_to_ten_digits(void **state) {
    (void)state;
    static const char *const methods[] = {
        "projection@dop853:rtol=1e-13",
        "reduced@dop853:rtol=1e-13",
        "index1@rk4:h=5e-4",
        "baumgarte:alpha=5,beta=5@rk4:h=5e-4",
        "projection:weight=euclidean@rk4:h=5e-4",
        "projection:what=velocity@rk4:h=5e-4",
        "nullspace@rk4:h=5e-4",
        "partitioning@rk4:h=5e-4",
        "projection@dopri5:rtol=1e-12",
    };
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        must_meet_reference("fb0", methods[i], 2e-10);
    }
}

static void the_tilted_four_bar_moves_like_the_upright_one(void **state) {
    (void)state;
    must_meet_reference("fb0-tilted", "projection@rk4:h=1e-4", 1e-12);
}

static void both_kinds_of_scene_move_alike(void **state) {
    (void)state;
    static const char *const methods[] = {
        "index1@rk4:h=1e-2", "baumgarte:alpha=5,beta=5@rk4:h=1e-2", "projection@rk4:h=1e-2"};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        hn_model joints, formulas;
        hn_model_open_closed(&joints, "fb0", NULL);
        hn_model_open_closed(&formulas, "fb0-lagrangian", NULL);
        hn_run *a = hn_motion_start(&joints, methods[i]),
               *b = hn_motion_start(&formulas, methods[i]);
        for (int k = 1; k <= 4; k++) {
            double qa[3], va[3], qb[3], vb[3];
            hn_sample sa = hn_motion_at(a, 0.25 * k), sb = hn_motion_at(b, 0.25 * k);
            read_angles(&joints, &sa, qa, va);
            read_angles(&formulas, &sb, qb, vb);
            assert_all_near(qa, qb, 3, 1e-13);
            assert_all_near(va, vb, 3, 1e-13 * 5); // rates are up to 5 rad/s
            assert_all_near(sa.lambda, sb.lambda, 2, 1e-13 * 20);
            assert_near(sa.energy, sb.energy, 1e-13 * 50);
        }
        hn_run_free(a);
        hn_run_free(b);
        hn_model_close(&joints);
        hn_model_close(&formulas);
    }
}

static void a_loop_closed_twice_moves_as_if_closed_once(void **state) {
    (void)state;
    static const char *const methods[] = {
        "index1@rk4:h=5e-3",       "baumgarte:alpha=5,beta=5@rk4:h=5e-3",
        "projection@rk4:h=5e-3",   "nullspace@rk4:h=5e-3",
        "partitioning@rk4:h=5e-3", "reduced@rk4:h=5e-3"};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        hn_model once, twice;
        hn_model_open_closed(&once, "fb0", NULL);
        hn_model_open_closed(&twice, "fb0-redundant", NULL);
        hn_run *a = hn_motion_start(&once, methods[i]), *b = hn_motion_start(&twice, methods[i]);
        for (int k = 1; k <= 2; k++) {
            hn_sample sa = hn_motion_at(a, k), sb = hn_motion_at(b, k);
            assert_all_near(sb.q, sa.q, 3, 1e-11);
            assert_all_near(sb.v, sa.v, 3, 1e-11);
            assert_int_equal(sb.rank, 2);

            // the force is shared: least norm puts half on each copy
            for (int j = 0; j < 2; j++) {
                assert_near(sb.lambda[j] + sb.lambda[2 + j], sa.lambda[j], 1e-10);
                assert_near(sb.lambda[j], sb.lambda[2 + j], 1e-10);
            }
        }
        hn_run_free(a);
        hn_run_free(b);
        hn_model_close(&once);
        hn_model_close(&twice);
    }
}

/// Angle from the upright, clockwise, and its rate: exact, ((N+1)/3 + N) th'' = g ((N+1)/2 + N) sin
/// th.
static void must_follow_ladder(const char *settings, const char *method, const double (*exact)[3],
                               int n, double tol) {
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", settings);
    hn_run *run = hn_motion_start(&m, method);
    int i0 = hn_model_user(&m, "th0"), i1 = hn_model_user(&m, "th1");
    for (int k = 0; k < n; k++) {
        hn_sample s = hn_motion_at(run, exact[k][0]);
        double upright = 1.57079632679489661923;
        assert_near(upright - s.q[i0], exact[k][1], tol);
        assert_near(-s.v[i0], exact[k][2], tol);
        assert_near(upright - s.q[i1], exact[k][1],
                    tol); // no vertical stays behind at the flat pose
    }
    hn_run_free(run);
    hn_model_close(&m);
}

static void one_four_bar_of_the_ladder_follows_its_exact_motion(void **state) {
    (void)state;
    static const double exact[][3] = {{1, 3.40535298793705789660222, 6.8755919485933150209174},
                                      {2, 6.36034732633128852334953, 1.03443484579602122422745}};
    must_follow_ladder("N=1", "projection@rk4:h=1e-3", exact, 2, 1e-8);
    must_follow_ladder("N=1", "projection@rk4:h=2e-4", exact, 2, 1e-10);
}

static void two_four_bars_pass_the_flat_pose_for_ten_seconds(void **state) {
    (void)state;
    static const double exact[][3] = {{1, 3.33787080310509773181796, 6.80738524086944553673435},
                                      {2, 6.34103336131233160565456, 1.01896459143853670654906},
                                      {5, 16.6543534866534826256098, 6.10506755351962098880328},
                                      {10, 31.7505971869861018170813, 1.50664218084182946989427}};
    must_follow_ladder("N=2", "projection@rk4:h=1e-3", exact, 4, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_closes_the_loop),
        cmocka_unit_test(projection_meets_the_reference_to_twelve_digits),
        cmocka_unit_test(reduced_coordinates_meet_the_reference_to_twelve_digits),
        cmocka_unit_test(every_sound_formulation_meets_the_reference_to_ten_digits),
        cmocka_unit_test(the_tilted_four_bar_moves_like_the_upright_one),
        cmocka_unit_test(both_kinds_of_scene_move_alike),
        cmocka_unit_test(a_loop_closed_twice_moves_as_if_closed_once),
        cmocka_unit_test(one_four_bar_of_the_ladder_follows_its_exact_motion),
        cmocka_unit_test(two_four_bars_pass_the_flat_pose_for_ten_seconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
