// SPDX-License-Identifier: GPL-3.0-or-later
// The solver of the accelerations is a choice: the same motion by each, a reason from each that
// cannot serve; and what is told at singular poses leads through them.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void every_solver_gives_the_same_motion(void **state) {
    (void)state;
    static const char *const methods[] = {"index1:%ssolver=%s@rk4:h=2e-3",
                                          "baumgarte:%ssolver=%s@rk4:h=2e-3",
                                          "projection:%ssolver=%s@rk4:h=2e-3"};
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (int k = 0; k < 3; k++) {
        double auto_q[3];
        for (int i = 0; i < HN_SOLVER_COUNT; i++) {
            char method[96];
            snprintf(method, sizeof method, methods[k], "", hn_solver_names[i]);
            hn_run *run = hn_motion_start(&m, method);
            const hn_sample s = hn_motion_at(run, 1);
            if (i == HN_SOLVER_AUTO) {
                memcpy(auto_q, s.q, sizeof auto_q);
            }
            // rounding grows by the sensitivity of this motion, below 100 after 1 s
            assert_all_near(s.q, auto_q, 3, 1e-13);
            assert_int_equal(hn_run_get_summary(run).cost.fallbacks, 0);
            hn_run_free(run);
        }
    }
    hn_model_close(&m);
}

static hn_run_summary try(const hn_model *m, const char *solver) {
    char method[96];
    snprintf(method, sizeof method, "index1:solver=%s@rk4:h=1e-3", solver);
    hn_run *run = hn_motion_start(m, method);
    (void)hn_run_advance(run, 0.1);
    const hn_run_summary s = hn_run_get_summary(run);
    hn_run_free(run);
    return s;
}

static void redundant_rows_are_refused_by_name_where_they_are_not_served(void **state) {
    (void)state;
    static const int serves[HN_SOLVER_COUNT] = {
        [HN_SOLVER_AUTO] = 1, [HN_SOLVER_PROXIMAL] = 1, [HN_SOLVER_LEAST_NORM] = 1};
    hn_model m;
    hn_model_open_closed(&m, "fb0-redundant", NULL);
    for (int i = 0; i < HN_SOLVER_COUNT; i++) {
        const hn_run_summary s = try(&m, hn_solver_names[i]);
        if (serves[i]) {
            assert_int_equal(s.status, HN_OK);
        } else {
            assert_int_equal(s.status, HN_ERR_SINGULAR);
            assert_non_null(strstr(s.reason, hn_solver_names[i]));
            assert_non_null(strstr(s.reason, "needs independent constraint equations"));
        }
    }
    hn_model_close(&m);
}

static void the_range_space_refuses_a_massless_rocker_and_names_it(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0-massless-rocker", NULL);
    for (int i = 0; i < HN_SOLVER_COUNT; i++) {
        const hn_run_summary s = try(&m, hn_solver_names[i]);
        if (i == HN_SOLVER_RANGE_SPACE) {
            assert_int_equal(s.status, HN_ERR_MASS);
            assert_non_null(strstr(s.reason, "th3 moves no mass"));
        } else {
            assert_int_equal(s.status, HN_OK);
        }
    }
    hn_model_close(&m);
}

static void symmetric_projection_refuses_a_massless_rocker_and_names_it(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0-massless-rocker", NULL);
    hn_run *run = hn_motion_start(&m, "symmetric-projection@midpoint:h=1e-3");
    assert_int_not_equal(hn_run_advance(run, 0.1), HN_OK);
    const hn_run_summary s = hn_run_get_summary(run);
    assert_non_null(
        strstr(s.reason, "needs the inverse of M, which does not exist: th3 moves no mass"));
    hn_run_free(run);
    hn_model_close(&m);
}

static void
a_method_that_divides_by_a_missing_mass_is_told_as_such_with_one_that_does_not(void **state) {
    static const char *const methods[] = {"ggl@radau5", "ggl@genalpha:h=1e-3",
                                          "symmetric-projection@rk4:h=1e-3",
                                          "index1:solver=range-space@rk4:h=1e-3"};
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0-massless-rocker", NULL);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        const hn_incident *incidents;
        hn_run *run = hn_motion_start(&m, methods[i]);
        assert_int_equal(hn_run_advance(run, 0.1), HN_ERR_MASS);
        assert_int_equal(hn_run_incidents(run, &incidents), 1);
        assert_int_equal(incidents[0].code, HN_INCIDENT_MASS);
        hn_run *other = hn_motion_start(&m, incidents[0].remedy[0]);
        assert_int_equal(hn_run_advance(other, 0.1), HN_OK);
        hn_run_free(other);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void answers_from_small_pivots_are_refined_and_counted(void **state) {
    (void)state;
    // a coupler a hundred thousand times lighter than its neighbours: pivots of 1e-5
    hn_model light, usual;
    hn_model_open_closed(&light, "fb0", "m2=0.001 m1=100 m3=100");
    hn_model_open_closed(&usual, "fb0", NULL);
    hn_run *run = hn_motion_start(&light, "index1@rk4:h=1e-3"),
           *other = hn_motion_start(&usual, "index1@rk4:h=1e-3");
    (void)hn_motion_at(run, 0.1);
    (void)hn_motion_at(other, 0.1);
    assert_int_equal(hn_run_get_summary(run).cost.refinements, 400);
    assert_int_equal(hn_run_get_summary(run).cost.fallbacks, 0);
    assert_int_equal(hn_run_get_summary(other).cost.refinements, 0);
    hn_run_free(run);
    hn_run_free(other);
    hn_model_close(&light);
    hn_model_close(&usual);
}

static const hn_incident *find(const hn_run *run, hn_incident_code code) {
    const hn_incident *incident = NULL;
    const int n = hn_run_incidents(run, &incident);
    for (int i = 0; i < n; i++) {
        if (incident[i].code == code) {
            return &incident[i];
        }
    }
    return NULL;
}

static void what_waits_at_the_flat_pose_is_told(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    (void)hn_motion_at(run, 1);
    const hn_incident *near = find(run, HN_INCIDENT_NEAR_SINGULAR);
    assert_non_null(near);
    assert_non_null(strstr(near->message, "B1: x"));
    assert_non_null(strstr(near->message, "between coupler 1 and vertical 1"));
    assert_non_null(strstr(near->message, "2 degrees of freedom there instead of 1"));
    assert_non_null(strstr(near->message, "two branches of motion cross"));
    assert_non_null(strstr(near->message, "stayed on the smooth path"));
    const hn_incident *ahead = find(run, HN_INCIDENT_RANK_AHEAD);
    assert_non_null(ahead);
    assert_near(ahead->t + ahead->value, 0.70845, 2e-3); // when the bars lie on one line
    hn_run_free(run);
    hn_model_close(&m);
}

static void the_remedy_for_a_chart_that_ends_at_a_flat_pose_goes_through_it(void **state) {
    (void)state;
    static const char *const methods[] = {"nullspace@rk4:h=0.01", "partitioning@rk4:h=0.01",
                                          "reduced@rk4:h=0.01", "projection@dopri5:rtol=1e-12"};
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    for (int k = 0; k < 4; k++) {
        hn_run *run = hn_motion_start(&m, methods[k]);
        if (hn_run_advance(run, 10) == HN_OK) {
            hn_run_free(run);
            continue; // nothing to mend
        }
        const hn_incident *incident = NULL;
        const int n = hn_run_incidents(run, &incident);
        assert_true(n > 0);
        // the last incident is the end of the run; its first remedy has to reach 10 s on the right
        // branch
        const char *remedy = incident[n - 1].remedy[0];
        assert_non_null(strchr(remedy, '@'));
        hn_run *mended = hn_motion_start(&m, remedy);
        const hn_sample s = hn_motion_at(mended, 10);
        const int th0 = hn_model_user(&m, "th0"), th1 = hn_model_user(&m, "th1");
        assert_near(remainder(s.q[th0] - s.q[th1], 6.283185307179586), 0, 1e-9);
        hn_run_free(mended);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void a_run_thrown_on_the_other_branch_says_so(void **state) {
    (void)state;
    // speeds alone projected: the gap lets the loop fold over at a flat pose
    int folded = 0;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    const int th0 = hn_model_user(&m, "th0"), th1 = hn_model_user(&m, "th1");
    for (int k = 0; k < 30; k++) {
        char method[80];
        hn_sample s = {0};
        snprintf(method, sizeof method, "projection:what=velocity@rk4:h=%.6f", 0.004 + 0.0005 * k);
        hn_run *run = hn_motion_start(&m, method);
        int off = 0;
        for (int i = 1; i <= 50 && hn_run_advance(run, 0.1 * i) == HN_OK && !off; i++) {
            assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
            off = fabs(remainder(s.q[th0] - s.q[th1], 6.283185307179586)) > 0.5;
        }
        if (off && s.gap < 1e-2) {
            folded++;
            assert_true(find(run, HN_INCIDENT_BRANCH_FLIP) || find(run, HN_INCIDENT_GAP_OPEN) ||
                        find(run, HN_INCIDENT_ENERGY_JUMP));
        }
        hn_run_free(run);
    }
    assert_true(folded > 0);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_solver_gives_the_same_motion),
        cmocka_unit_test(redundant_rows_are_refused_by_name_where_they_are_not_served),
        cmocka_unit_test(the_range_space_refuses_a_massless_rocker_and_names_it),
        cmocka_unit_test(symmetric_projection_refuses_a_massless_rocker_and_names_it),
        cmocka_unit_test(
            a_method_that_divides_by_a_missing_mass_is_told_as_such_with_one_that_does_not),
        cmocka_unit_test(answers_from_small_pivots_are_refined_and_counted),
        cmocka_unit_test(what_waits_at_the_flat_pose_is_told),
        cmocka_unit_test(the_remedy_for_a_chart_that_ends_at_a_flat_pose_goes_through_it),
        cmocka_unit_test(a_run_thrown_on_the_other_branch_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
