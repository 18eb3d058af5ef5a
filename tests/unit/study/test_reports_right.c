// SPDX-License-Identifier: GPL-3.0-or-later
// Reports that would be false are not made, or are withdrawn.
#include "study/incidents/ahead.h"
#include "study/incidents/report.h"
#include "support/model.h"
#include "support/motion.h"
#include "support/near.h"

#include <string.h>

static const hn_incident *find(const hn_run *run, hn_incident_code code) {
    const hn_incident *list = NULL;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        if (list[i].code == code) {
            return &list[i];
        }
    }
    return NULL;
}

// A swing of 3e-8 rad has 4e-15 J, about the last bit of a potential of 10 J: a change of that size
// is no drift and no jump.
static void rounding_of_the_energy_is_no_drift(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "pendulum", NULL);
    m.q[0] = 3e-8;
    m.v[0] = 0;
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=0.01");
    assert_int_equal(hn_run_advance(run, 5), HN_OK);
    assert_true(hn_run_get_summary(run).worst_energy_change > 0);
    assert_null(find(run, HN_INCIDENT_ENERGY_DRIFT));
    assert_null(find(run, HN_INCIDENT_ENERGY_JUMP));
    hn_run_free(run);

    // six rods hold a platform at rest, without gravity: its energy of 1e-105 J is none
    hn_model rods;
    hn_model_open_closed(&rods, "stewart-rods", NULL);
    run = hn_motion_start(&rods, "ggl@radau5:rtol=1e-6");
    assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
    assert_null(find(run, HN_INCIDENT_ENERGY_DRIFT));
    assert_null(find(run, HN_INCIDENT_ENERGY_JUMP));
    hn_run_free(run);
    hn_model_close(&rods);

    // a loss that is real is reported, and once: the energy is lost from then on
    m.q[0] = 1;
    run = hn_motion_start(&m, "projection@rk4:h=0.2");
    (void)hn_run_advance(run, 40);
    assert_non_null(find(run, HN_INCIDENT_ENERGY_DRIFT));
    const hn_incident *list = NULL;
    int reports = 0;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        reports += list[i].code == HN_INCIDENT_ENERGY_DRIFT;
    }
    assert_int_equal(reports, 1);
    hn_run_free(run);

    // where one step loses it the jump alone is reported, with the change since the start
    run = hn_motion_start(&m, "projection@rk4:h=0.4");
    (void)hn_run_advance(run, 40);
    assert_null(find(run, HN_INCIDENT_ENERGY_DRIFT));
    const hn_incident *jump = find(run, HN_INCIDENT_ENERGY_JUMP);
    assert_non_null(jump);
    assert_non_null(strstr(jump->message, "; since the start it has changed by "));
    hn_run_free(run);
    hn_model_close(&m);
}

static void a_prediction_that_did_not_come_true_is_withdrawn(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=0.01");
    assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
    assert_null(find(run, HN_INCIDENT_RANK_AHEAD)); // a regular crank-rocker

    // a prediction for the present, on a motion that stays regular
    hn_watch *w = hn_run_watching(run);
    hn_incident *i = hn_incident_report(w, &hn_incident_rank_ahead, "time to go", 0, 0, "soon");
    assert_non_null(i);
    w->singular.announced = 1 + (int)(i - w->log.list);
    w->singular.lowest = w->singular.info.sigma_min;
    const unsigned revision = i->revision;
    assert_int_equal(hn_run_step(run), HN_OK);
    assert_non_null(strstr(i->message, "withdrawn at t = 0.51 s"));
    assert_true(i->revision > revision);
    hn_run_free(run);
    hn_model_close(&m);
}

// Links that all but line up turn by more than a radian within a few steps. That is the motion, as
// the accelerations say, and no other branch.
// Bars in line twice a turn. Steps that choose their length are as long as a third of the way from
// one to the next: the next prediction is due while the last one is hardly over.
static void every_change_point_is_announced_whatever_the_steps_are(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@rk4:h=1e-3", "projection@dop853:rtol=1e-6",
                                          "projection@dopri5:rtol=1e-5"};
    hn_model m;
    hn_model_open_closed(&m, "parallelogram", NULL);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        hn_run *run = hn_motion_start(&m, methods[k]);
        assert_int_equal(hn_run_advance(run, 3), HN_OK);
        const hn_incident *list = NULL;
        const int n = hn_run_incidents(run, &list);
        int events = 0;
        for (int i = 0; i < n; i++) {
            if (list[i].code != HN_INCIDENT_NEAR_SINGULAR) {
                continue;
            }
            // the report before it is its prediction
            events++;
            assert_true(i > 0 && list[i - 1].code == HN_INCIDENT_RANK_AHEAD);
            assert_near(list[i - 1].t + list[i - 1].value, list[i].t, 0.01);
            assert_null(strstr(list[i - 1].message, "withdrawn"));
        }
        assert_true(events >= 5);
        // the first one by small steps: 0.2 s before
        assert_true(k > 0 || list[0].value >= 0.2);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void a_sharp_turn_is_no_other_branch(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@rk4:h=0.005", "nullspace-tangent@rk4:h=0.005",
                                          "projection@rk4:h=0.0025"};
    hn_model m;
    hn_model_open_closed(&m, "four-bar", "l2=0.859496 l3=0.625323");
    for (int i = 0; i < 3; i++) {
        hn_run *run = hn_motion_start(&m, methods[i]);
        assert_int_equal(hn_run_advance(run, 5), HN_OK);
        const hn_incident *flip = find(run, HN_INCIDENT_BRANCH_FLIP);
        if (flip) {
            fail_msg("%s: %s", methods[i], flip->message);
        }
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// An extrapolation method crosses a dead point of the car axis in one step of 0.3 s. The two ends
// of the step lie on different sides of it, and short steps lead from one to the other.
static void a_long_step_of_high_order_is_no_jump(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@gsl-bsimp:rtol=1e-6",
                                          "index1@gsl-bsimp:rtol=1e-8"};
    hn_model m;
    hn_model_open_closed(&m, "car-axis", NULL);
    for (int i = 0; i < 2; i++) {
        hn_run *run = hn_motion_start(&m, methods[i]);
        assert_int_equal(hn_run_advance(run, 3), HN_OK);
        const hn_incident *flip = find(run, HN_INCIDENT_BRANCH_FLIP);
        if (flip) {
            fail_msg("%s: %s", methods[i], flip->message);
        }
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// Links all but line up, and the springs of a penalty let the loop open there: the velocities swing
// across the motion, which says nothing about the branch.
static void velocities_of_open_loops_are_no_other_branch(void **state) {
    (void)state;
    static const struct {
        const char *scene, *settings, *method;
        double t;
    } cases[] = {
        {"four-bar", "l1=1.015 l4=1.382 m1=30.54 m2=0.07814 th1_0=0.5655", "penalty@rk4:h=0.01",
         1.2},
        {"spatial-slider-crank", "pz=-0.06108 m2=0.01122 m3=10.53 g=3.285 w_0=-34.44",
         "penalty@rk4:h=0.001", 0.3},
    };
    for (int i = 0; i < 2; i++) {
        hn_model m;
        hn_model_open_closed(&m, cases[i].scene, cases[i].settings);
        hn_run *run = hn_motion_start(&m, cases[i].method);
        assert_int_equal(hn_run_advance(run, cases[i].t), HN_OK);
        const hn_incident *flip = find(run, HN_INCIDENT_BRANCH_FLIP);
        if (flip) {
            fail_msg("%s: %s", cases[i].scene, flip->message);
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
}

// Peaucellier's linkage starts from rest, and half a turn at its first velocities is a long time: a
// pilot run with steps that are too long for it sees a singular configuration where none is.
static void a_pilot_run_follows_a_motion_that_becomes_faster(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "peaucellier", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=2e-3");
    assert_int_equal(hn_run_advance(run, 7), HN_OK);
    assert_null(find(run, HN_INCIDENT_RANK_AHEAD));
    hn_run_free(run);

    // and a true one is announced a quarter of a turn before, again and again
    hn_model_close(&m);
    hn_model_open_closed(&m, "parallelogram", NULL);
    run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    assert_int_equal(hn_run_advance(run, 1.9), HN_OK);
    const hn_incident *list = NULL;
    int announced = 0;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        if (list[i].code == HN_INCIDENT_RANK_AHEAD) {
            assert_true(list[i].value > (announced > 0 ? 0.25 : 0.19)); // of turns of 0.82 s
            announced++;
        }
    }
    assert_int_equal(announced, 5);
    hn_run_free(run);
    hn_model_close(&m);
}

// A heavy block and a light crank: the pivots of J M^-1 J' differ by 1e4 everywhere, and J is far
// from losing rank.
static void unlike_masses_are_no_singular_configuration(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "quick-return",
                         "r=0.3032 mA=51.5 mR=21.79 rho=0.07423 g=20.73 th_0=1.182");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    assert_int_equal(hn_run_advance(run, 2), HN_OK);
    assert_null(find(run, HN_INCIDENT_NEAR_SINGULAR));
    hn_run_free(run);
    hn_model_close(&m);
}

// Three of the five rows of this shaft depend on the others. At rest gamma vanishes and what the
// rows ask for is the pull on a gap of rounding alone, on which they agree as far as it has digits.
static void rows_that_pull_on_rounding_contradict_nothing(void **state) {
    (void)state;
    static const char *const settings[] = {"w_0=0", "w_0=1e-9", "w_0=1e-3"};
    for (int i = 0; i < 3; i++) {
        hn_model m;
        hn_model_open_closed(&m, "cardan-shaft", settings[i]);
        const hn_run_summary s =
            hn_motion_summary(&m, "baumgarte:alpha=10,beta=10@rk4:h=1e-3", 0.1);
        if (s.status != HN_OK) {
            fail_msg("%s: %s", settings[i], s.reason);
        }
        hn_model_close(&m);
    }
}

// A step above the stability limit: the velocities grow without bound, and the multipliers as their
// squares. No rows of J are dependent there. Bars that all but line up are told all the same.
static void multipliers_of_a_run_that_blows_up_are_no_singular_configuration(void **state) {
    (void)state;
    static const char *const cases[][3] = {
        {"slider-crank", "r=0.6151 l=3.358 m3=902.1 T0=-33.46", "udwadia-kalaba@rk4:h=1e-3"},
        {"quick-return", "r=0.3239 l=0.8798 mA=0.2691 mR=88.07 kd=540.5 th_0=1.663",
         "penalty@rk4:h=1e-3"},
        {"quick-return", "d=0.13 mR=0.0076 rho=0.01248 g=21.61 w_m=1.675 kd=973.3",
         "udwadia-kalaba@rk4:h=1e-3"},
        {"quick-return", "kd=783.7", "projection@rk4:h=1e-3"},
    };
    hn_model m;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_model_open_closed(&m, cases[i][0], cases[i][1]);
        hn_run *run = hn_motion_start(&m, cases[i][2]);
        assert_int_equal(hn_run_advance(run, 1), HN_ERR_DIVERGED);
        assert_null(find(run, HN_INCIDENT_MULTIPLIERS));
        assert_true(i < 3 || !find(run, HN_INCIDENT_NEAR_SINGULAR));
        hn_run_free(run);
        hn_model_close(&m);
    }

    hn_model_open_closed(&m, "parallelogram", NULL);
    hn_run *run = hn_motion_start(&m, "penalty@rk4:h=1e-3");
    assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
    assert_non_null(find(run, HN_INCIDENT_MULTIPLIERS));
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounding_of_the_energy_is_no_drift),
        cmocka_unit_test(rows_that_pull_on_rounding_contradict_nothing),
        cmocka_unit_test(a_long_step_of_high_order_is_no_jump),
        cmocka_unit_test(velocities_of_open_loops_are_no_other_branch),
        cmocka_unit_test(a_pilot_run_follows_a_motion_that_becomes_faster),
        cmocka_unit_test(multipliers_of_a_run_that_blows_up_are_no_singular_configuration),
        cmocka_unit_test(unlike_masses_are_no_singular_configuration),
        cmocka_unit_test(every_change_point_is_announced_whatever_the_steps_are),
        cmocka_unit_test(a_sharp_turn_is_no_other_branch),
        cmocka_unit_test(a_prediction_that_did_not_come_true_is_withdrawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
