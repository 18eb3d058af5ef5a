// SPDX-License-Identifier: GPL-3.0-or-later
// The findings after something went wrong: the cause by name, and remedies that were tried.
#include "study/run/diagnosis.h"
#include "support/model.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const hn_incident *last_of(const hn_run *run) {
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(run, &list);
    assert_true(n > 0);
    return &list[n - 1];
}

// the stability study of this mechanism predicts 675 us and finds 670 us; kd = 678 decays at 4.1e3
// 1/s
static void a_step_above_the_stability_limit_is_named_as_the_cause(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "five-bar", "kd=678 lf=1.42");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    assert_true(hn_run_advance(run, 1) != HN_OK);
    const unsigned revision = last_of(run)->revision;
    hn_run_diagnose(run);
    const hn_incident *end = last_of(run);
    assert_true(end->revision > revision);
    assert_non_null(strstr(end->message, "above the stability limit of rk4 here, 0.000675 s"));
    assert_non_null(strstr(end->message, "the damping of 'left motor' decays at 4.1e+03 1/s"));
    assert_non_null(strstr(hn_run_get_summary(run).reason, "above the stability limit"));

    // what is offered was tried, and does what was said
    assert_string_equal(end->remedy[0], "h=0.00025");
    assert_non_null(strstr(end->tried[0], "tried until t = "));
    hn_run *cured = hn_motion_start(&m, "projection@rk4:h=0.00025");
    assert_int_equal(hn_run_advance(cured, 1), HN_OK);
    hn_run_free(cured);
    hn_run_free(run);

    // below the limit nothing of the kind is said
    run = hn_motion_start(&m, "projection@rk4:h=6e-4");
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    hn_run_diagnose(run);
    const hn_incident *list = NULL;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        assert_null(strstr(list[i].message, "stability limit"));
    }
    hn_run_free(run);
    hn_model_close(&m);
}

/// The largest gap that a run shows, with samples 0.02 s apart.
static double gap_shown(const hn_model *m, const char *method, double t_end) {
    hn_run *run = hn_motion_start(m, method);
    for (int k = 1; k <= t_end / 0.02; k++) {
        (void)hn_motion_at(run, 0.02 * k);
    }
    const double gap = hn_run_get_summary(run).worst_gap;
    hn_run_free(run);
    return gap;
}

// Radau's states are closed to rounding at the ends of its steps, and to 1e-8 to 1e-5 between them
static void the_outcome_of_a_remedy_is_what_running_it_shows(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=0.1");
    (void)hn_run_advance(run, 2);
    hn_run_diagnose(run);
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(run, &list);
    int compared = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < HN_REMEDIES && list[i].remedy[j][0]; j++) {
            double t, gap;
            if (sscanf(list[i].tried[j], "tried until t = %lf s: largest gap %lf m", &t, &gap) ==
                    2 &&
                strncmp(list[i].remedy[j], "ggl@radau5", 10) == 0) {
                const double shown = gap_shown(&m, list[i].remedy[j], t);
                assert_true(shown > 1e-9);
                // other times of the same steps: within a decade
                assert_true(gap > shown / 10 && gap < 10 * shown);
                compared++;
            }
        }
    }
    assert_true(compared > 0);
    hn_run_free(run);
    hn_model_close(&m);
}

// finer steps of index-1 drift as well, only later; projection does not
static void remedies_that_do_not_remove_it_are_not_offered(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.02");
    (void)hn_run_advance(run, 10);
    hn_run_diagnose(run);
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(run, &list);
    int tried = 0;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < HN_REMEDIES && list[i].remedy[k][0]; k++) {
            tried += list[i].tried[k][0] != '\0';
        }
        if (strstr(list[i].message, "none of the remedies")) {
            assert_true(list[i].remedy[0][0] == '\0');
        }
    }
    assert_true(tried > 0);
    assert_int_equal(list[0].code, HN_INCIDENT_GAP_OPEN);
    assert_string_equal(list[0].remedy[0], "projection@rk4:h=0.02");

    // asked again nothing changes
    const unsigned revision = list[n - 1].revision;
    hn_run_diagnose(run);
    assert_int_equal(list[n - 1].revision, revision);
    hn_run_free(run);
    hn_model_close(&m);
}

// a vibration that no step of 2.5 ms resolves: only the implicit method is left of three
static void where_finer_steps_fail_an_implicit_method_is_left(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "stiff-four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-2");
    assert_true(hn_run_advance(run, 1) != HN_OK);
    assert_string_equal(last_of(run)->remedy[0], "h=0.0025"); // before it is tried
    hn_run_diagnose(run);
    const hn_incident *end = last_of(run);
    assert_non_null(strstr(end->message, "oscillates at"));
    for (int k = 0; k < HN_REMEDIES && end->remedy[k][0]; k++) {
        assert_string_not_equal(end->remedy[k], "h=0.0025");
    }
    hn_run_free(run);
    hn_model_close(&m);
}

// The load behind the fastest mode has its name, whether it is a formula, a damper or a spring.
// Where the motion is fast, and the mechanism at rest is slow, the fastest link is named: rigid
// links without springs do not vibrate.
static void the_load_that_limits_the_step_is_named(void **state) {
    (void)state;
    static const struct {
        const char *scene, *settings, *method, *words;
    } cases[] = {
        {"quick-return", "kd=500", "projection@rk4:h=1e-3", "the damping of 'motor' decays at"},
        {"stiff-four-bar", "k=1e9", "index1@rk4:h=5e-4", "the stiffness of 'spring' oscillates at"},
        {"slider-crank", NULL, "index1@euler:h=0.01", "(the links turn fast, w1 = 23 rad/s; a dev"},
        {"double-pendulum", NULL, "index1@euler:h=0.1", "the links turn fast, wa2 = -8.4 rad/s; a"},
        // coupler and rocker all but stretched, 0.4 um from their greatest reach
        {"four-bar", "l1=2.5 l3=0.932719", "baumgarte@rk4:h=0.01",
         "w3 = 3.3e+03 rad/s, as the start is near a dead point of th1 (w1 = 4); a deviation"},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        hn_model m;
        hn_model_open_closed(&m, cases[c].scene, cases[c].settings);
        hn_run *run = hn_motion_start(&m, cases[c].method);
        assert_true(hn_run_advance(run, 3) != HN_OK);
        hn_run_diagnose(run);
        if (!strstr(last_of(run)->message, cases[c].words)) {
            fail_msg("%s: %s", cases[c].scene, last_of(run)->message);
        }
        hn_run_free(run);
        hn_model_close(&m);
    }
}

// Three reports of one run: what removes all of them is offered for each, and first.
static void the_reports_of_a_run_agree_on_what_helps(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.05");
    assert_int_equal(hn_run_advance(run, 3), HN_OK);
    hn_run_diagnose(run);
    const hn_incident *list = NULL;
    int wrong = 0;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        if (hn_incident_kinds()[list[i].code]->is_wrong) {
            assert_string_equal(list[i].remedy[0], "ggl@radau5:rtol=1e-06");
            wrong++;
        }
    }
    assert_true(wrong >= 3);
    hn_run_free(run);
    hn_model_close(&m);
}

// a loop that opens after 160,000 steps: trials begin shortly before, and their gap is that of the
// remedy, not the one that the run had left open
static void remedies_of_a_late_event_are_tried_from_the_state_before_it(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=2e-3");
    const hn_incident *list = NULL;
    double t = 0;
    while (hn_run_incidents(run, &list) == 0 && t < 300) {
        assert_int_equal(hn_run_advance(run, t += 1), HN_OK);
    }
    assert_int_equal(hn_run_incidents(run, &list), 1);
    const double event = list[0].t;
    assert_true(event > 10 && event / 2e-3 > 5000); // far more steps than a trial may take

    // the run goes on: what was before the event is not lost
    assert_int_equal(hn_run_advance(run, event + 20), HN_OK);
    hn_run_diagnose(run);
    hn_run_incidents(run, &list);
    assert_string_equal(list[0].remedy[0], "projection@rk4:h=0.002");
    double from, to, gap;
    assert_int_equal(sscanf(list[0].tried[0],
                            "tried from t = %lf s until t = %lf s: last gap %lf m", &from, &to,
                            &gap),
                     3);
    assert_true(from < event && event - from < 1);
    assert_true(to > event && to < event + 1);
    assert_true(gap < 1e-12); // closed to rounding
    for (int k = 0; k < HN_REMEDIES && list[0].remedy[k][0]; k++) {
        assert_null(strstr(list[0].tried[k], "not tried"));
    }
    hn_run_free(run);
    hn_model_close(&m);
}

// weights of 1e100 N make the first step overflow: no trial gets past it, and none is offered
static void what_fails_at_the_start_is_no_remedy(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", "g=1e100");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    assert_int_equal(hn_run_advance(run, 1), HN_ERR_DIVERGED);
    hn_run_diagnose(run);
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(run, &list);
    assert_true(n > 0);
    for (int i = 0; i < n; i++) {
        assert_string_equal(list[i].remedy[0], "");
        assert_null(strstr(list[i].message, "nearly dependent")); // J is as regular as before
    }
    assert_non_null(strstr(last_of(run)->message, "tried in vain"));
    hn_run_free(run);
    hn_model_close(&m);
}

// collinear links are passed by 0.2 mm: at h = 0.01 the energy jumps there, and the wrong motion
// ends where no pose is left; four times as many steps pass
static void an_end_after_a_wrong_motion_says_since_when_it_was_wrong(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", "l2=0.859496 l3=0.625323");
    hn_run *run = hn_motion_start(&m, "nullspace@rk4:h=0.01");
    assert_true(hn_run_advance(run, 10) != HN_OK);
    hn_run_diagnose(run);
    const hn_incident *end = last_of(run);
    assert_non_null(strstr(end->message, "no configuration closes the loops"));
    assert_non_null(
        strstr(end->message, "; the motion was wrong from t = 0.5 s on (the energy jumped)"));
    assert_string_equal(end->message, hn_run_get_summary(run).reason);
    assert_string_equal(end->remedy[0], "h=0.0025");
    assert_non_null(strstr(end->tried[0], "tried from t = "));
    hn_run_free(run);
    run = hn_motion_start(&m, "nullspace@rk4:h=0.0025");
    assert_int_equal(hn_run_advance(run, 10), HN_OK);
    hn_run_free(run);
    hn_model_close(&m);
}

// 45 roundings: no step of any size meets it, and a finer tolerance still less
static void a_tolerance_near_rounding_is_answered_by_a_coarser_one(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "slider-crank", NULL);
    hn_run *run = hn_motion_start(&m, "ggl@radau5:rtol=1e-14");
    assert_int_equal(hn_run_advance(run, 5), HN_ERR_NO_CONVERGENCE);
    hn_run_diagnose(run);
    assert_string_equal(last_of(run)->remedy[0], "rtol=1e-12");
    hn_run_free(run);
    run = hn_motion_start(&m, "ggl@radau5:rtol=1e-12");
    assert_int_equal(hn_run_advance(run, 5), HN_OK);
    hn_run_free(run);
    hn_model_close(&m);
}

// A quarter of the step is above the limit of 2.2e-4 s too: its short trial is not far off yet, and
// the motion is wrong by 245 rad/s after 2 s.
static void a_step_above_the_limit_is_no_remedy(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "quick-return", "kd=783.7");
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    assert_true(hn_run_advance(run, 2) != HN_OK);
    hn_run_diagnose(run);
    const hn_incident *end = last_of(run);
    for (int i = 0; i < HN_REMEDIES; i++) {
        assert_string_not_equal(end->remedy[i], "h=0.00025");
    }
    assert_non_null(strstr(end->remedy[0], "ggl@radau5"));
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_above_the_stability_limit_is_named_as_the_cause),
        cmocka_unit_test(a_step_above_the_limit_is_no_remedy),
        cmocka_unit_test(the_load_that_limits_the_step_is_named),
        cmocka_unit_test(the_reports_of_a_run_agree_on_what_helps),
        cmocka_unit_test(the_outcome_of_a_remedy_is_what_running_it_shows),
        cmocka_unit_test(remedies_that_do_not_remove_it_are_not_offered),
        cmocka_unit_test(remedies_of_a_late_event_are_tried_from_the_state_before_it),
        cmocka_unit_test(what_fails_at_the_start_is_no_remedy),
        cmocka_unit_test(an_end_after_a_wrong_motion_says_since_when_it_was_wrong),
        cmocka_unit_test(where_finer_steps_fail_an_implicit_method_is_left),
        cmocka_unit_test(a_tolerance_near_rounding_is_answered_by_a_coarser_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
