// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/motion.h"
#include "support/near.h"
#include "support/trial.h"

#include "dynamics/compile/drawing.h"
#include "dynamics/evaluate/eval.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SCENE(name) "lessons/11-cabinet/scenes/" name ".json"

static void open_scene(hn_trial *trial, const char *name, const hn_setting *settings, int n) {
    char path[128];
    snprintf(path, sizeof path, SCENE("%s"), name);
    hn_trial_open_with(trial, path, settings, n);
}

/// A place on a body in a sample, by the label of a drawn point.
static const double *point(const hn_trial *trial, const hn_sample *s, const char *label) {
    const hn_drawing d = hn_system_drawing(trial->sys);
    for (int i = 0; i < d.n_points; i++) {
        if (d.labels[i] && strcmp(d.labels[i], label) == 0) {
            return s->points + 3 * i;
        }
    }
    fail_msg("no point %s", label);
    return NULL;
}

static void freedoms_and_rank_are_those_of_the_books(void **state) {
    (void)state;
    static const hn_trial_count known[] = {
        {SCENE("parallelogram"), 1, 2, 2}, {SCENE("double-rocker"), 1, 2, 2},
        {SCENE("triple-rocker"), 1, 2, 2}, {SCENE("watt-six-bar"), 1, 4, 4},
        {SCENE("peaucellier"), 1, 6, 6},   {SCENE("stephenson-six-bar"), 1, 4, 4},
        {SCENE("pantograph"), 2, 2, 2},    {SCENE("scott-russell"), 1, 2, 2},
        {SCENE("quick-return"), 1, 4, 4},  {SCENE("3-rrr"), 3, 4, 4},
        {SCENE("ring"), 10, 2, 2},         {SCENE("bennett"), 1, 2, 5},
    };
    hn_trial_check_counts(known, sizeof known / sizeof known[0]);
}

static void peaucelliers_point_stays_on_its_line(void **state) {
    (void)state;
    const hn_setting wide[] = {{"L", 1.1}, {"s", 0.45}, {"k", 0.8}, {"th_0", -1}};
    hn_trial trial;
    open_scene(&trial, "peaucellier", wide, 4);
    const double line = -(1.1 * 1.1 - 0.45 * 0.45) / (2 * 0.8 * (1.1 - 0.45));
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    double left = 0, right = 0;
    for (int k = 1; k <= 150; k++) {
        const hn_sample s = hn_motion_at(run, 0.02 * k);
        const double *P = point(&trial, &s, "P");
        assert_near(P[1], line, 1e-9);
        left = fmin(left, P[0]);
        right = fmax(right, P[0]);
    }
    assert_true(right - left > 0.5); // it did move
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void scott_russells_point_runs_level_through_the_pivot(void **state) {
    (void)state;
    hn_trial trial;
    open_scene(&trial, "scott-russell", NULL, 0);
    const int th = hn_trial_coordinate(&trial, "th");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    double left = 0, right = 0;
    for (int k = 1; k <= 150; k++) {
        const hn_sample s = hn_motion_at(run, 0.02 * k);
        const double *P = point(&trial, &s, "P");
        assert_near(P[1], 0, 1e-9);
        assert_near(P[0], 2 * 0.5 * cos(s.q[th]), 1e-9);
        left = fmin(left, P[0]);
        right = fmax(right, P[0]);
    }
    assert_true(right - left > 1);
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void a_pantograph_enlarges_what_its_tracer_draws(void **state) {
    (void)state;
    static const double ratios[] = {0.2, 0.4, 0.75};
    for (int i = 0; i < 3; i++) {
        const hn_setting k = {"k", ratios[i]};
        hn_trial trial;
        open_scene(&trial, "pantograph", &k, 1);
        hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
        double travelled = 0, last[2] = {0, 0};
        for (int step = 1; step <= 40; step++) {
            const hn_sample s = hn_motion_at(run, 0.05 * step);
            const double *P = point(&trial, &s, "P"), *D = point(&trial, &s, "D");
            for (int c = 0; c < 2; c++) {
                assert_near(D[c], ratios[i] * P[c], 1e-10);
            }
            travelled += step > 1 ? hypot(P[0] - last[0], P[1] - last[1]) : 0;
            memcpy(last, P, sizeof last);
        }
        assert_true(travelled > 0.5);
        hn_run_free(run);
        hn_trial_close(&trial);
    }
}

static void a_parallelogram_stays_parallel_and_swings_as_a_pendulum(void **state) {
    (void)state;
    // slow enough to stay below the line of its pivots
    const hn_setting hanging[] = {{"th_0", -2}, {"w_0", 1}};
    const double a = 0.6, d = 1.4, T = 2;
    hn_trial trial;
    open_scene(&trial, "parallelogram", hanging, 2);
    const int th1 = hn_trial_coordinate(&trial, "th1"), a2 = hn_trial_coordinate(&trial, "a2"),
              th3 = hn_trial_coordinate(&trial, "th3");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    const double pull = 9.81 * (a + d) / ((2 * a / 3 + d) * a);
    double th = -2, w = 1, h = 1e-5;
    for (int k = 0; k < (int)lround(T / h); k++) { // midpoint rule, error of the order of h^2
        const double mid = th + h / 2 * w, w_mid = w - h / 2 * pull * cos(th);
        th += h * w_mid;
        w -= h * pull * cos(mid);
    }
    const hn_sample s = hn_motion_at(run, T);
    assert_near(s.q[th1], th, 1e-8);
    assert_near(s.q[th3], s.q[th1], 1e-12);
    assert_near(s.q[th1] + s.q[a2], 0, 1e-12);
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void whitworths_ram_has_the_stroke_and_the_time_ratio_of_the_formula(void **state) {
    (void)state;
    // without gravity the motor turns the crank steadily; the formula is about its angles, whatever
    // its speed
    const hn_setting level = {"g", 0};
    const double r = 0.3, d = 0.15, e = 0.2, l = 0.7;
    hn_trial trial;
    open_scene(&trial, "quick-return", &level, 1);
    const int x = hn_trial_coordinate(&trial, "x"), th1 = hn_trial_coordinate(&trial, "th1");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=2e-4");
    double most = -9, least = 9, angle_most = 0, angle_least = 0;
    for (int k = 1; k <= 2600; k++) {
        const hn_sample s = hn_motion_at(run, 5e-4 * k);
        if (s.q[x] > most) {
            most = s.q[x];
            angle_most = s.q[th1];
        }
        if (s.q[x] < least) {
            least = s.q[x];
            angle_least = s.q[th1];
        }
    }
    assert_near(most, l + e, 1e-5);
    assert_near(least, l - e, 1e-5);
    const double between = fabs(angle_most - angle_least);
    const double small = acos(-1) - 2 * asin(d / r);
    assert_near(fmin(between, 2 * acos(-1) - between), small,
                1e-2); // 2 samples are 0.005 rad apart
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void a_ring_keeps_its_energy_to_the_order_of_the_method(void **state) {
    (void)state;
    double worst[2];
    for (int i = 0; i < 2; i++) {
        hn_trial trial;
        open_scene(&trial, "ring", NULL, 0);
        hn_run *run = hn_trial_run(&trial, i ? "projection@rk4:h=1e-3" : "projection@rk4:h=2e-3");
        hn_motion_at(run, 0.4); // later it is chaotic
        worst[i] = hn_run_get_summary(run).worst_energy_change;
        hn_run_free(run);
        hn_trial_close(&trial);
    }
    assert_true(worst[1] < 1e-6);
    assert_true(worst[0] > 10 * worst[1]);
}

static void a_ring_of_three_is_a_triangle_that_swings_as_a_pendulum(void **state) {
    (void)state;
    const hn_setting three = {"n", 3};
    hn_trial trial;
    open_scene(&trial, "ring", &three, 1);
    // side l = 1 m: centre at l/sqrt 3 from the pivot, inertia about it m (l^2/12 + l^2/12) plus m
    // l^2/3: m l^2/2
    const double centre = 1 / sqrt(3), inertia = 0.5;
    const int th1 = hn_trial_coordinate(&trial, "th1");
    hn_run *run = hn_trial_run(&trial, "projection@rk4:h=1e-3");
    double angle = 0, w = 0, h = 1e-5;
    for (int k = 0; k < 150000; k++) {
        const double mid = angle + h / 2 * w,
                     w_mid = w - h / 2 * 9.81 * centre / inertia * cos(angle);
        angle += h * w_mid;
        w -= h * 9.81 * centre / inertia * cos(mid);
    }
    const hn_sample s = hn_motion_at(run, 1.5);
    assert_near(s.q[th1], angle - acos(-1) / 6, 1e-7);
    hn_run_free(run);
    hn_trial_close(&trial);
}

static void a_ring_of_any_size_falls_by_every_family(void **state) {
    (void)state;
    static const struct {
        const char *method;
        int n;
    } cases[] = {{"index1@rk4:h=5e-4", 3},
                 {"projection@rk4:h=5e-4", 7},
                 {"nullspace@rk4:h=2e-4", 12},
                 {"baumgarte:alpha=5,beta=5@rk4:h=5e-4", 20},
                 {"projection@rk4:h=2e-4", 60}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const hn_setting n = {"n", cases[i].n};
        hn_trial trial;
        open_scene(&trial, "ring", &n, 1);
        assert_int_equal(trial.info.nv - trial.info.nc, cases[i].n - 2);
        hn_run *run = hn_trial_run(&trial, cases[i].method);
        const hn_sample s = hn_motion_at(run, 0.5);
        assert_true(fabs(s.energy_change) < 5e-5 && s.gap < 1e-6);
        hn_run_free(run);
        hn_trial_close(&trial);
    }
}

static void bennetts_loop_moves_with_three_rows_too_many(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@rk4:h=1e-3", "nullspace@rk4:h=1e-3",
                                          "index1@rk4:h=1e-3",
                                          "baumgarte:alpha=5,beta=5@rk4:h=1e-3"};
    static const double gaps[] = {1e-13, 1e-13, 1e-5, 1e-8};
    hn_trial trial;
    open_scene(&trial, "bennett", NULL, 0);
    const int th1 = hn_trial_coordinate(&trial, "th1"), th2 = hn_trial_coordinate(&trial, "th2");
    const double ratio = sin(0.9) / sin(0.3); // Bennett 1914: of (be + al)/2 and (be - al)/2
    double end = 0;
    for (int i = 0; i < 4; i++) {
        hn_run *run = hn_trial_run(&trial, methods[i]);
        for (int k = 1; k <= 20; k++) {
            const hn_sample s = hn_motion_at(run, 0.1 * k);
            assert_true(s.gap < gaps[i]);
            assert_near(fabs(tan(s.q[th1] / 2) * tan(s.q[th2] / 2)) / ratio, 1, 1e-3);
            assert_near(s.energy_change, 0, 1e-6);
            end = i == 0 && k == 20 ? s.q[th1] : end;
            assert_true(k < 20 || fabs(s.q[th1] - end) < 1e-4);
        }
        hn_run_free(run);
    }
    hn_trial_close(&trial);
}

static void every_setting_in_the_ranges_closes_the_loops(void **state) {
    (void)state;
    static const char *const scenes[] = {
        "parallelogram",      "double-rocker", "triple-rocker", "watt-six-bar",
        "stephenson-six-bar", "peaucellier",   "pantograph",    "scott-russell",
        "quick-return",       "3-rrr",         "bennett"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        char path[128];
        snprintf(path, sizeof path, SCENE("%s"), scenes[i]);
        hn_trial_try_ranges(path);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(freedoms_and_rank_are_those_of_the_books),
        cmocka_unit_test(peaucelliers_point_stays_on_its_line),
        cmocka_unit_test(scott_russells_point_runs_level_through_the_pivot),
        cmocka_unit_test(a_pantograph_enlarges_what_its_tracer_draws),
        cmocka_unit_test(a_parallelogram_stays_parallel_and_swings_as_a_pendulum),
        cmocka_unit_test(whitworths_ram_has_the_stroke_and_the_time_ratio_of_the_formula),
        cmocka_unit_test(a_ring_keeps_its_energy_to_the_order_of_the_method),
        cmocka_unit_test(a_ring_of_three_is_a_triangle_that_swings_as_a_pendulum),
        cmocka_unit_test(a_ring_of_any_size_falls_by_every_family),
        cmocka_unit_test(bennetts_loop_moves_with_three_rows_too_many),
        cmocka_unit_test(every_setting_in_the_ranges_closes_the_loops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
