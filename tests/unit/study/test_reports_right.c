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

    // a loss that is real is reported
    m.q[0] = 1;
    run = hn_motion_start(&m, "projection@rk4:h=0.4");
    (void)hn_run_advance(run, 40);
    assert_non_null(find(run, HN_INCIDENT_ENERGY_DRIFT));
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounding_of_the_energy_is_no_drift),
        cmocka_unit_test(a_sharp_turn_is_no_other_branch),
        cmocka_unit_test(a_prediction_that_did_not_come_true_is_withdrawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
