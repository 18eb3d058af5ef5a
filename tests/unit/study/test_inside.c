// SPDX-License-Identifier: GPL-3.0-or-later
// Output between steps is checked like the steps themselves.
#include "support/near.h"
#include "support/trial.h"

#include <math.h>

#define FOUR_BAR HN_TRIAL_LESSON "four-bar.json"

static const hn_incident *find(const hn_run *run, hn_incident_code code) {
    const hn_incident *list = NULL;
    for (int i = 0, n = hn_run_incidents(run, &list); i < n; i++) {
        if (list[i].code == code) {
            return &list[i];
        }
    }
    return NULL;
}

static hn_run *start(hn_trial *trial, const char *method, double t_end, double warn_gap) {
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run_opts opts = hn_run_opts_default();
    hn_run *run = NULL;
    opts.t_end = t_end;
    opts.warn_gap = warn_gap;
    assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
    assert_int_equal(hn_run_create(trial->sys, &spec, trial->q, trial->v, &opts, &run, &diag),
                     HN_OK);
    return run;
}

// the crank starts with 14 J; a step of 2 s cut off at 1 s gives it 2e5 J with closed loops
static void a_sample_ahead_with_another_energy_is_reported(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FOUR_BAR);
    hn_run *run = start(&trial, "projection@rk4:h=2", 1, 0);
    hn_sample s;
    const hn_incident *longer = find(run, HN_INCIDENT_STEP_LONG);
    assert_non_null(longer);
    assert_string_equal(longer->remedy[0], "h=0.01");
    assert_int_equal(hn_run_sample(run, 1, &s), HN_OK);
    const hn_incident *jump = find(run, HN_INCIDENT_ENERGY_JUMP);
    assert_non_null(jump);
    assert_near(jump->t, 1, 0);
    assert_int_equal(hn_run_get_summary(run).samples_inside, 1);
    assert_true(hn_run_get_summary(run).worst_energy_change > 1e5);
    hn_run_free(run);

    // with the step of the remedy nothing of it is left
    run = start(&trial, "projection@rk4:h=0.01", 1, 0);
    assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
    assert_int_equal(hn_run_sample(run, 0.505, &s), HN_OK);
    const hn_incident *list;
    assert_int_equal(hn_run_incidents(run, &list), 0);
    assert_int_equal(hn_run_get_summary(run).samples_inside, 1);
    hn_run_free(run);
    hn_trial_close(&trial);
}

// the collocation polynomial closes the loops at its nodes alone
static void the_worst_gap_covers_what_is_put_out(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FOUR_BAR);
    hn_run *run = start(&trial, "ggl@radau5:rtol=1e-5", 0, 0);
    double worst = 0;
    while (hn_run_time(run) < 3) {
        const double t = hn_run_time(run);
        hn_sample s;
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_int_equal(hn_run_sample(run, 0.5 * (t + hn_run_time(run)), &s), HN_OK);
        worst = fmax(worst, s.gap);
    }
    assert_true(worst > 1e-9); // far above the 1e-14 of the steps
    assert_near(hn_run_get_summary(run).worst_gap, worst, 0);
    hn_run_free(run);
    hn_trial_close(&trial);
}

// a gap that is open between the steps alone
static void an_open_sample_is_reported(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, FOUR_BAR);
    hn_run *run = start(&trial, "ggl@radau5:rtol=1e-5", 0, 1e-9);
    hn_sample s;
    for (int k = 0; k < 60; k++) {
        assert_int_equal(hn_run_step(run), HN_OK);
    }
    assert_null(find(run, HN_INCIDENT_GAP_OPEN)); // the steps are closed to 1e-14
    for (int k = 0; k < 60; k++) {
        const double t = hn_run_time(run);
        assert_int_equal(hn_run_step(run), HN_OK);
        assert_int_equal(hn_run_sample(run, 0.5 * (t + hn_run_time(run)), &s), HN_OK);
    }
    const hn_incident *open = find(run, HN_INCIDENT_GAP_OPEN);
    assert_non_null(open);
    assert_true(open->value > open->limit);
    hn_run_free(run);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sample_ahead_with_another_energy_is_reported),
        cmocka_unit_test(the_worst_gap_covers_what_is_put_out),
        cmocka_unit_test(an_open_sample_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
