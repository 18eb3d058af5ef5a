// SPDX-License-Identifier: GPL-3.0-or-later
// The radar of singular poses: closed forms of sigma, the time of the next pose, the freedoms and
// branches there.

#include "dynamics/analyse/singularity_monitor.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NV = 32 };

static hn_singularity *open_radar(hn_model *m, const char *json, const char *setting) {
    hn_singularity *r = NULL;
    if (json) {
        hn_model_open_text(m, json, NULL);
    } else {
        hn_model_open_closed(m, "n-four-bar", setting);
    }
    assert_int_equal(hn_singularity_create(m->sys, m->arena, &r), HN_OK);
    return r;
}

static void close_radar(hn_model *m, hn_singularity *r) {
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
    hn_singularity *r = open_radar(&m, NULL, "N=1");
    double q[MAX_NV], first = 0;
    hn_singularity_info info;
    lean(&m, 1, 1.5707963267948966, q);
    hn_singularity_check(r, 0, q, &info);
    assert_near(info.sigma_max, 1,
                0.05); // upright the rows are almost orthogonal, each of length 1
    for (int k = 0; k < 5; k++) {
        for (int turn = 0; turn < 20; turn++) { // a look improves the last one
            lean(&m, 1, angle[k], q);
            hn_singularity_check(r, 1 + k, q, &info);
        }
        first = k == 1 ? info.sigma_min / angle[k] : first;
        if (k > 1) {
            assert_rel(info.sigma_min / angle[k], first, 1e-3); // up to th^2
        }
        assert_true(info.sigma_min < info.sigma_max);
    }
    lean(&m, 1, 0, q);
    hn_singularity_check(r, 9, q, &info);
    assert_near(info.sigma_min, 0, 1e-12);
    assert_int_equal(info.lost, 1);
    close_radar(&m, r);
}

static void a_probe_sees_what_a_look_sees_and_says_nothing_of_it(void **state) {
    (void)state;
    hn_model m;
    hn_singularity *r = open_radar(&m, NULL, "N=1"), *other = NULL;
    double q[MAX_NV];
    hn_singularity_info info, alone;
    assert_int_equal(hn_singularity_create(m.sys, m.arena, &other), HN_OK);
    assert_true(hn_singularity_probe(r, 0, m.q) ==
                HUGE_VAL); // what rows count is known from the first look on
    for (int k = 0; k <= 120; k++) {
        const double t = 0.01 * k, inside = 1.5 - t - 0.3;
        lean(&m, 1, 1.5 - t, q);
        hn_singularity_check(r, t, q, &info);
        hn_singularity_check(other, t, q, &alone);
        assert_near(info.sigma_min, alone.sigma_min, 0);
        assert_true(info.ahead == alone.ahead); // HUGE_VAL mostly
        lean(&m, 1, inside, q);
        const double sigma = hn_singularity_probe(r, t, q);
        assert_true(fabs(inside) > 0.05 ? sigma > 0.03 : sigma < 0.05); // like the angle itself
    }
    hn_singularity_free(other);
    close_radar(&m, r);
}

static void a_ladder_lying_flat_has_a_freedom_for_each_loop_more(void **state) {
    (void)state;
    static const int loops[] = {1, 2, 5, 10};
    for (int k = 0; k < 4; k++) {
        char setting[16];
        double q[MAX_NV];
        hn_model m;
        hn_singularity_info info;
        hn_singularity_pose pose;
        snprintf(setting, sizeof setting, "N=%d", loops[k]);
        hn_singularity *r = open_radar(&m, NULL, setting);
        hn_singularity_check(r, 0, m.q, &info);
        lean(&m, loops[k], 1e-4, q);
        hn_singularity_check(r, 1, q, &info);
        hn_singularity_check(r, 1, q, &info);
        hn_singularity_pose_at(r, 1, q, info.sigma_min, &pose);
        assert_int_equal(pose.mobility_before, 1);
        assert_int_equal(pose.mobility, loops[k] + 1);
        assert_true(pose.n_rows > 0);
        assert_int_equal(hn_system_row_name(m.sys, pose.rows[0])[0], 'B');
        assert_int_equal(pose.branches, loops[k] == 1 ? HN_BRANCHES_CROSS : HN_BRANCHES_UNKNOWN);
        close_radar(&m, r);
    }
}

static void the_time_of_the_flat_pose_is_said_before_it_comes(void **state) {
    (void)state;
    hn_model m;
    hn_singularity *r = open_radar(&m, NULL, "N=1");
    double q[MAX_NV];
    int said = 0;
    for (int k = 0; k <= 140; k++) {
        hn_singularity_info info;
        const double t = 0.01 * k; // turns at 1 rad/s: flat at pi/2
        lean(&m, 1, 1.5707963267948966 - t, q);
        hn_singularity_check(r, t, q, &info);
        if (info.ahead < HUGE_VAL) {
            said++;
            assert_rel(t + info.ahead, 1.5707963267948966, 0.02);
        }
    }
    assert_true(said >= 3);
    close_radar(&m, r);
}

static void a_pose_that_is_only_passed_near_is_not_announced(void **state) {
    (void)state;
    // x^2 / 4 - y^2 = 0.01 keeps clear of the crossing at the origin by 0.1
    static const char json[] =
        "{\"holonom\": 1, \"name\": \"near\", \"lagrangian\": {\"coordinates\": [{\"name\": \"x\", "
        "\"unit\": \"m\"}, {\"name\": \"y\", \"unit\": \"m\"}], \"kinetic\": \"(d_x^2 + d_y^2)/2\","
        "\"constraints\": [{\"name\": \"curve\", \"formula\": \"x^2/4 - y^2 + 0.01\"}]},"
        "\"start\": {\"positions\": {\"x\": 2, \"y\": {\"guess\": 1}}}}";
    hn_model m;
    hn_singularity *r = open_radar(&m, json, NULL);
    for (int k = 0; k <= 400; k++) {
        hn_singularity_info info;
        const double t = 0.01 * k, x = 2 - t, q[2] = {x, sqrt(x * x / 4 + 0.01)};
        hn_singularity_check(r, t, q, &info);
        assert_true(info.ahead == HUGE_VAL);
        assert_true(info.sigma_min > 0.05);
    }
    close_radar(&m, r);
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
    hn_singularity *r = open_radar(&m, json, NULL);
    const double away[2] = {1, 1}, there[2] = {0, 1e-12};
    hn_singularity_check(r, 0, away, &info);
    hn_singularity_check(r, 1, there, &info);
    hn_singularity_pose_at(r, 1, there, info.sigma_min, &pose);
    assert_int_equal(pose.mobility, 2);
    close_radar(&m, r);
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
    hn_singularity *r = open_radar(&m, NULL, "N=5");
    hn_singularity_info info;
    hn_singularity_pose pose;
    const long before = hn_alloc_count();
    hn_singularity_check(r, 0, m.q, &info);
    hn_singularity_pose_at(r, 0, m.q, info.sigma_min, &pose);
    (void)hn_singularity_probe(r, 0, m.q);
    assert_int_equal(hn_alloc_count(), before);
    close_radar(&m, r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loop_of_the_ladder_loses_a_rank_like_its_angle),
        cmocka_unit_test(a_probe_sees_what_a_look_sees_and_says_nothing_of_it),
        cmocka_unit_test(a_ladder_lying_flat_has_a_freedom_for_each_loop_more),
        cmocka_unit_test(the_time_of_the_flat_pose_is_said_before_it_comes),
        cmocka_unit_test(a_pose_that_is_only_passed_near_is_not_announced),
        cmocka_unit_test(branches_are_the_tangents_of_the_curve),
        cmocka_unit_test(a_look_costs_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
