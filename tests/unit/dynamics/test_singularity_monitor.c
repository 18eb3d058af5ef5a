// SPDX-License-Identifier: GPL-3.0-or-later
// The singularity monitor: closed forms of sigma, the time of the next singular configuration, the
// degrees of freedom and branches there.

#include "dynamics/analyse/pilot.h"
#include "dynamics/analyse/singularity_monitor.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NV = 96 };
static const double AT_REST[MAX_NV];

static hn_singularity *open_monitor(hn_model *m, const char *json, const char *setting) {
    hn_singularity *r = NULL;
    if (json) {
        hn_model_open_text(m, json, NULL);
    } else {
        hn_model_open_closed(m, "n-four-bar", setting);
    }
    assert_int_equal(hn_singularity_create(m->sys, m->arena, &r), HN_OK);
    return r;
}

static void close_monitor(hn_model *m, hn_singularity *r) {
    hn_singularity_free(r);
    hn_model_close(m);
}

/// The ladder with all verticals at angle th to the ground and level couplers.
static void lean(const hn_model *m, int n_loops, double th, double *q) {
    for (int i = 0; i < m->info.nq; i++) {
        q[i] = i <= n_loops ? th : 0;
    }
}

static void a_loop_of_the_ladder_loses_a_rank_like_its_angle(void **state) {
    (void)state;
    // a = |row x| and b = |row y| of J D against their largest lengths, masses 4/3 (first crank
    // with its coupler), 1/3, 1/3: near the flat pose row x is th (k1, 0, k2) and row y (k1, k3,
    // k2), so that sigma_min is proportional to th
    static const double angle[] = {1e-1, 1e-2, 1e-3, 1e-5, 1e-7};
    hn_model m;
    hn_singularity *r = open_monitor(&m, NULL, "N=1");
    double q[MAX_NV], first = 0;
    hn_singularity_info info;
    lean(&m, 1, 1.5707963267948966, q);
    hn_singularity_check(r, 0, q, AT_REST, &info);
    assert_near(info.sigma_max, 1,
                0.05); // upright the rows are almost orthogonal, each of length 1
    for (int k = 0; k < 5; k++) {
        for (int turn = 0; turn < 20; turn++) { // a look improves the last one
            lean(&m, 1, angle[k], q);
            hn_singularity_check(r, 1 + k, q, AT_REST, &info);
        }
        first = k == 1 ? info.sigma_min / angle[k] : first;
        if (k > 1) {
            assert_rel(info.sigma_min / angle[k], first, 1e-3); // up to th^2
        }
        assert_true(info.sigma_min < info.sigma_max);
    }
    lean(&m, 1, 0, q);
    hn_singularity_check(r, 9, q, AT_REST, &info);
    assert_near(info.sigma_min, 0, 1e-12);
    assert_int_equal(info.lost, 1);
    close_monitor(&m, r);
}

static void a_probe_sees_what_a_look_sees_and_says_nothing_of_it(void **state) {
    (void)state;
    hn_model m;
    hn_singularity *r = open_monitor(&m, NULL, "N=1"), *other = NULL;
    double q[MAX_NV];
    hn_singularity_info info, alone;
    assert_int_equal(hn_singularity_create(m.sys, m.arena, &other), HN_OK);
    assert_true(hn_singularity_probe(r, 0, m.q) ==
                HUGE_VAL);           // what rows count is known from the first look on
    for (int k = 0; k <= 170; k++) { // flat at 150: two dependent rows, answered by iteration
        const double t = 0.01 * k, inside = 1.5 - t - 0.3;
        lean(&m, 1, 1.5 - t, q);
        hn_singularity_check(r, t, q, AT_REST, &info);
        hn_singularity_check(other, t, q, AT_REST, &alone);
        assert_near(info.sigma_min, alone.sigma_min, 0);
        assert_true(info.ahead == alone.ahead); // HUGE_VAL mostly
        lean(&m, 1, inside, q);
        const double sigma = hn_singularity_probe(r, t, q);
        assert_true(fabs(inside) > 0.05 ? sigma > 0.03 : sigma < 0.05); // like the angle itself
    }
    hn_singularity_free(other);
    close_monitor(&m, r);
}

static void a_ladder_lying_flat_has_a_freedom_for_each_loop_more(void **state) {
    (void)state;
    static const int loops[] = {1, 2, 5, 10, 20, 40};
    for (int k = 0; k < 6; k++) {
        char setting[16];
        double q[MAX_NV];
        hn_model m;
        hn_singularity_info info;
        hn_singularity_pose pose;
        snprintf(setting, sizeof setting, "N=%d", loops[k]);
        hn_singularity *r = open_monitor(&m, NULL, setting);
        hn_singularity_check(r, 0, m.q, AT_REST, &info);
        lean(&m, loops[k], 1e-4, q);
        hn_singularity_check(r, 1, q, AT_REST, &info);
        hn_singularity_check(r, 1, q, AT_REST, &info);
        hn_singularity_pose_at(r, 1, q, info.sigma_min, &pose);
        assert_int_equal(pose.mobility_before, 1);
        assert_int_equal(pose.mobility, loops[k] + 1);
        assert_true(pose.n_rows > 0);
        assert_int_equal(hn_system_row_name(m.sys, pose.rows[0])[0], 'B');
        assert_int_equal(pose.branches, loops[k] == 1 ? HN_BRANCHES_CROSS : HN_BRANCHES_UNKNOWN);
        close_monitor(&m, r);
    }
}

static void the_time_of_the_flat_configuration_is_announced_once_and_early(void **state) {
    (void)state;
    hn_model m;
    hn_singularity *r = open_monitor(&m, NULL, "N=1 g=0");
    double q[MAX_NV];
    int announced = 0;
    for (int k = 0; k <= 150; k++) {
        hn_singularity_info info;
        const double t = 0.01 * k, v[3] = {-1, -1, 0}; // without gravity it turns evenly
        lean(&m, 1, 1.5707963267948966 - t, q);
        hn_singularity_check(r, t, q, v, &info);
        if (info.ahead < HUGE_VAL) {
            announced++;
            assert_near(t + info.ahead, 1.5707963267948966, 1e-4);
            assert_true(info.ahead > 0.2);
        }
    }
    assert_int_equal(announced, 1);
    close_monitor(&m, r);
}

/// Announcements along the true motion of a scene; *t: the last time announced, *early: the least
/// time before it.
static int count_announcements(const char *scene, double duration, double *t, double *early) {
    hn_model m;
    hn_singularity *r = NULL;
    hn_pilot *run = NULL;
    int announced = 0;
    hn_model_open_closed(&m, scene, NULL);
    assert_int_equal(hn_singularity_create(m.sys, m.arena, &r), HN_OK);
    assert_int_equal(hn_pilot_create(m.sys, m.arena, &run), HN_OK);
    hn_pilot_start(run, 0, m.q, m.v);
    *early = HUGE_VAL;
    for (int k = 0; hn_pilot_time(run) < duration; k++) {
        hn_singularity_info info;
        if (k % 10 == 0) {
            hn_singularity_check(r, hn_pilot_time(run), hn_pilot_q(run), hn_pilot_v(run), &info);
            if (info.ahead < HUGE_VAL) {
                announced++;
                *early = fmin(*early, info.ahead);
                *t = hn_pilot_time(run) + info.ahead;
            }
        }
        assert_int_equal(hn_pilot_step(run, 1e-3), HN_OK);
    }
    hn_pilot_free(run);
    close_monitor(&m, r);
    return announced;
}

// Shortest and longest link of the shipped four-bar are 1.7 m together, the others 1.8 m: it turns
// over and J keeps its rank (sigma_min is 0.27 at the least, where a straight line through its last
// values would be 0.08 s from zero). The parallelogram lies flat at th1 = pi.
static void a_crank_rocker_is_never_announced_and_a_parallelogram_is(void **state) {
    (void)state;
    double t = 0, early;
    assert_int_equal(count_announcements("four-bar", 10, &t, &early), 0);
    assert_int_equal(count_announcements("parallelogram", 0.33, &t, &early), 1);
    assert_near(t, 0.3448, 1e-4); // where the run of the scene crosses it
    assert_true(early > 0.15);
}

static void a_configuration_that_is_only_passed_near_is_not_announced(void **state) {
    (void)state;
    // x^2 / 4 - y^2 = 0.01 keeps clear of the crossing at the origin by 0.1
    static const char json[] =
        "{\"holonom\": 1, \"name\": \"near\", \"lagrangian\": {\"coordinates\": [{\"name\": \"x\", "
        "\"unit\": \"m\"}, {\"name\": \"y\", \"unit\": \"m\"}], \"kinetic\": \"(d_x^2 + d_y^2)/2\","
        "\"constraints\": [{\"name\": \"curve\", \"formula\": \"x^2/4 - y^2 + 0.01\"}]},"
        "\"start\": {\"positions\": {\"x\": 2, \"y\": {\"guess\": 1}}}}";
    hn_model m;
    hn_singularity *r = open_monitor(&m, json, NULL);
    for (int k = 0; k <= 400; k++) {
        hn_singularity_info info;
        const double t = 0.01 * k, x = 2 - t, q[2] = {x, sqrt(x * x / 4 + 0.01)};
        const double v[2] = {-1, -x / (4 * q[1])};
        hn_singularity_check(r, t, q, v, &info);
        assert_true(info.ahead == HUGE_VAL);
        assert_true(info.sigma_min > 0.05);
    }
    close_monitor(&m, r);
}

static hn_branches branches_of(const char *formula) {
    char json[512];
    hn_model m;
    hn_singularity_info info;
    hn_singularity_pose pose;
    snprintf(
        json, sizeof json,
        "{\"holonom\": 1, \"name\": \"curve\", \"lagrangian\": {\"coordinates\": [{\"name\": "
        "\"x\", \"unit\": \"m\"}, {\"name\": \"y\", \"unit\": \"m\"}], \"kinetic\": \"(d_x^2 + "
        "d_y^2)/2\", \"constraints\": [{\"name\": \"curve\", \"formula\": \"%s\"}]},"
        "\"start\": {\"positions\": {\"x\": {\"guess\": 1}, \"y\": {\"guess\": 1}}}}",
        formula);
    hn_singularity *r = open_monitor(&m, json, NULL);
    const double away[2] = {1, 1}, there[2] = {0, 1e-12};
    hn_singularity_check(r, 0, away, AT_REST, &info);
    hn_singularity_check(r, 1, there, AT_REST, &info);
    hn_singularity_pose_at(r, 1, there, info.sigma_min, &pose);
    assert_int_equal(pose.mobility, 2);
    close_monitor(&m, r);
    return pose.branches;
}

static void branches_are_the_tangents_of_the_curve(void **state) {
    (void)state;
    assert_int_equal(branches_of("x^2 - y^2"), HN_BRANCHES_CROSS);         // two lines
    assert_int_equal(branches_of("x*(x - 2*y)"), HN_BRANCHES_CROSS);       // two lines
    assert_int_equal(branches_of("x^2 + 3*y^2"), HN_BRANCHES_NONE);        // a point
    assert_int_equal(branches_of("y^2 - x^3"), HN_BRANCHES_CUSP);          // a cusp
    assert_int_equal(branches_of("y^2 - x^2*(x + 1)"), HN_BRANCHES_CROSS); // a loop crossing itself
}

static void a_look_costs_no_memory(void **state) {
    (void)state;
    hn_model m;
    hn_singularity *r = open_monitor(&m, NULL, "N=5");
    hn_singularity_info info;
    hn_singularity_pose pose;
    const long before = hn_alloc_count();
    hn_singularity_check(r, 0, m.q, AT_REST, &info);
    hn_singularity_pose_at(r, 0, m.q, info.sigma_min, &pose);
    (void)hn_singularity_probe(r, 0, m.q);
    assert_int_equal(hn_alloc_count(), before);
    close_monitor(&m, r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loop_of_the_ladder_loses_a_rank_like_its_angle),
        cmocka_unit_test(a_probe_sees_what_a_look_sees_and_says_nothing_of_it),
        cmocka_unit_test(a_ladder_lying_flat_has_a_freedom_for_each_loop_more),
        cmocka_unit_test(the_time_of_the_flat_configuration_is_announced_once_and_early),
        cmocka_unit_test(a_crank_rocker_is_never_announced_and_a_parallelogram_is),
        cmocka_unit_test(a_configuration_that_is_only_passed_near_is_not_announced),
        cmocka_unit_test(branches_are_the_tangents_of_the_curve),
        cmocka_unit_test(a_look_costs_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
