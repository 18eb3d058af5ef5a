// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"
#include "support/near.h"
#include "support/trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FB0 HN_TRIAL_LESSON "fb0.json"
#define FOUR_BAR HN_TRIAL_LESSON "four-bar.json"

static hn_trial trial;

static int open_fb0(void **state) {
    (void)state;
    hn_trial_open(&trial, FB0);
    return 0;
}

static int close_trial(void **state) {
    (void)state;
    hn_trial_close(&trial);
    return 0;
}

static void grid_times_are_exact_multiples_of_the_step(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "index1@rk4:h=0.01");
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_true(hn_run_time(run) == 1.0); // 100 additions of 0.01 would end at 1.0000000000000007
    assert_int_equal(hn_run_get_summary(run).steps, 100);
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_int_equal(hn_run_get_summary(run).steps, 100);
    assert_int_equal(hn_run_step(run), HN_OK);
    assert_true(hn_run_time(run) == 101 * 0.01);
    assert_int_equal(hn_run_get_summary(run).state, HN_RUN_RUNNING);
    hn_run_free(run);
}

static const char *const methods[] = {
    "index1@rk4:h=0.005",
    "baumgarte@rk4:h=0.005",
    "baumgarte:rule=auto@rk4:h=0.005",
    "projection@rk4:h=0.005",
    "nullspace@rk4:h=0.005",
    "nullspace-as-printed@rk4:h=0.005",
    "partitioning@rk4:h=0.005",
    "reduced@rk4:h=0.005",
    "index1@dopri5:rtol=1e-8",
    "projection@dopri5:rtol=1e-8",
    "nullspace@dopri5:rtol=1e-8",
    "reduced@dopri5:rtol=1e-8",
    "partitioning@dopri5:rtol=1e-8",
    "index1@symplectic-euler:h=0.001",
    "reduced@heun:h=0.002",
    "nullspace@symplectic-euler:h=0.001",
    "projection@euler:h=0.001",
};
enum { N_METHODS = sizeof methods / sizeof methods[0] };

static void steps_and_samples_do_not_allocate(void **state) {
    (void)state;
    for (int i = 0; i < N_METHODS; i++) {
        hn_run *run = hn_trial_run(&trial, methods[i]);
        hn_sample sample;
        const long before = hn_alloc_count();
        assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run), &sample), HN_OK);
        assert_int_equal(hn_run_sample(run, hn_run_time(run) - 1e-4, &sample), HN_OK);
        assert_int_equal(hn_run_reset(run), HN_OK);
        assert_int_equal(hn_run_advance(run, 0.1), HN_OK);
        assert_int_equal(hn_alloc_count(), before);
        hn_run_free(run);
    }
}

// the whole outcome of a run as bytes
typedef struct outcome {
    double q[8], v[8], a[8], lambda[8], gap, energy, t;
    long long steps, evals;
} outcome;

static outcome outcome_of(hn_run *run) {
    outcome o;
    hn_sample s;
    memset(&o, 0, sizeof o);
    assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
    memcpy(o.q, s.q, (size_t)trial.info.n_user * sizeof(double));
    memcpy(o.v, s.v, (size_t)trial.info.n_user * sizeof(double));
    memcpy(o.a, s.a, (size_t)trial.info.n_user * sizeof(double));
    memcpy(o.lambda, s.lambda, (size_t)trial.info.nc * sizeof(double));
    o.gap = s.gap;
    o.energy = s.energy;
    o.t = s.t;
    o.steps = hn_run_get_summary(run).steps;
    o.evals = hn_run_get_summary(run).cost.evals;
    return o;
}

static void a_second_run_and_a_reset_give_the_same_bits(void **state) {
    (void)state;
    for (int i = 0; i < N_METHODS; i++) {
        hn_run *a = hn_trial_run(&trial, methods[i]), *b = hn_trial_run(&trial, methods[i]);
        assert_int_equal(hn_run_advance(a, 1), HN_OK);
        assert_int_equal(hn_run_advance(b, 1), HN_OK);
        const outcome first = outcome_of(a), second = outcome_of(b);
        assert_memory_equal(&first, &second, sizeof first);
        assert_int_equal(hn_run_reset(a), HN_OK);
        assert_int_equal(hn_run_get_summary(a).steps, 0);
        assert_int_equal(hn_run_advance(a, 1), HN_OK);
        const outcome again = outcome_of(a);
        assert_memory_equal(&first, &again, sizeof first);
        hn_run_free(a);
        hn_run_free(b);
    }
}

static void sampling_on_the_way_leaves_the_run_as_it_was(void **state) {
    (void)state;
    for (int i = 0; i < N_METHODS; i++) {
        hn_run *quiet = hn_trial_run(&trial, methods[i]), *asked = hn_trial_run(&trial, methods[i]);
        assert_int_equal(hn_run_advance(quiet, 1), HN_OK);
        for (int k = 1; k <= 37; k++) {
            hn_sample s;
            const double t = k / 37.0;
            assert_int_equal(hn_run_advance(asked, t), HN_OK);
            assert_int_equal(hn_run_sample(asked, t, &s), HN_OK);
            assert_true(s.t == t);
        }
        assert_int_equal(hn_run_advance(asked, 1), HN_OK);
        const outcome a = outcome_of(quiet), b = outcome_of(asked);
        assert_memory_equal(&a, &b, sizeof a);
        hn_run_free(quiet);
        hn_run_free(asked);
    }
}

static void a_sample_between_steps_is_as_good_as_the_steps(void **state) {
    (void)state;
    // two kinds: side steps and dense output, against a fine run on the very time
    static const char *const spellings[] = {
        "index1@rk4:h=0.01",       "reduced@rk4:h=0.01",          "projection@rk4:h=0.01",
        "index1@dopri5:rtol=1e-9", "projection@dopri5:rtol=1e-9", "partitioning@dopri5:rtol=1e-9"};
    const double t = 0.7 + 1.0 / 3000;
    hn_run *fine = hn_trial_run(&trial, "projection@dopri5:rtol=1e-12");
    hn_sample reference, s;
    assert_int_equal(hn_run_advance(fine, t), HN_OK);
    assert_int_equal(hn_run_sample(fine, t, &reference), HN_OK);
    for (size_t i = 0; i < sizeof spellings / sizeof spellings[0]; i++) {
        hn_run *run = hn_trial_run(&trial, spellings[i]);
        assert_int_equal(hn_run_advance(run, t), HN_OK);
        assert_int_equal(hn_run_sample(run, t, &s), HN_OK);
        assert_all_near(s.q, reference.q, 3, 1e-6);
        assert_all_near(s.v, reference.v, 3, 1e-5);
        hn_run_free(run);
    }
    hn_run_free(fine);
}

static void interpolated_states_of_projection_are_closed(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "projection@dopri5:rtol=1e-4");
    double worst = 0;
    for (int k = 1; k <= 100; k++) {
        hn_sample s;
        assert_int_equal(hn_run_advance(run, 0.0173 * k), HN_OK);
        assert_int_equal(hn_run_sample(run, 0.0173 * k, &s), HN_OK);
        worst = fmax(worst, fmax(s.gap, s.velocity_gap));
    }
    assert_true(worst < 1e-12);
    hn_run_free(run);
}

static void a_fixed_run_can_look_ahead_by_less_than_a_step_and_no_further(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "index1@rk4:h=0.01");
    hn_run *half = hn_trial_run(&trial, "index1@rk4:h=0.005");
    hn_sample ahead, exact;
    assert_int_equal(hn_run_sample(run, 0.005, &ahead), HN_OK);
    assert_true(hn_run_time(run) == 0);
    assert_int_equal(hn_run_step(half), HN_OK);
    assert_int_equal(hn_run_sample(half, 0.005, &exact), HN_OK);
    assert_all_near(ahead.q, exact.q, 3, 0);
    double kept[3];
    memcpy(kept, exact.q, sizeof kept);
    assert_int_equal(hn_run_sample(run, 0.02, &ahead), HN_ERR_INPUT);
    assert_int_equal(hn_run_sample(run, -0.001, &ahead), HN_ERR_INPUT);
    assert_int_equal(hn_run_sample(run, nan(""), &ahead), HN_ERR_INPUT);
    hn_run_free(run);
    hn_run_free(half);
}

static void multipliers_and_accelerations_of_a_sample_are_those_of_the_saddle_system(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "reduced@rk4:h=0.001");
    hn_sample s;
    assert_int_equal(hn_run_sample(run, 0, &s), HN_OK);
    // the reference values of this four-bar
    assert_near(s.lambda[0], 0.921838074449043, 1e-12);
    assert_near(s.lambda[1], 6.630912100630129, 1e-12);
    assert_near(s.energy, 49.34675722838445, 1e-11);
    assert_int_equal(s.rank, 2);
    hn_run_free(run);
}

static void a_diverged_run_keeps_its_last_good_state_and_its_reason(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "baumgarte:alpha=300,beta=300@rk4:h=0.02");
    const hn_incident *incidents = NULL;
    hn_sample s;
    assert_int_equal(hn_run_advance(run, 10), HN_ERR_DIVERGED);
    const hn_run_summary summary = hn_run_get_summary(run);
    assert_int_equal(summary.state, HN_RUN_FAILED);
    assert_int_equal(summary.status, HN_ERR_DIVERGED);
    assert_true(summary.t < 1 && summary.reason[0] != '\0');
    assert_int_equal(hn_run_sample(run, summary.t, &s), HN_OK);
    assert_true(isfinite(s.q[0]) && isfinite(s.gap) && isfinite(s.energy));
    assert_int_equal(hn_run_advance(run, 11), HN_ERR_DIVERGED);
    const int n = hn_run_incidents(run, &incidents);
    assert_int_equal(incidents[0].code, HN_INCIDENT_STEP_LIMIT);
    assert_int_equal(incidents[n - 1].code, HN_INCIDENT_DIVERGED);
    // the remedy of the limit removes the failure
    hn_run *cured = hn_trial_run(&trial, incidents[0].remedy[0]);
    assert_int_equal(hn_run_advance(cured, 10), HN_OK);
    hn_run_free(cured);
    hn_run_free(run);
}

static void an_open_gap_is_told_once_with_a_remedy_that_closes_it(void **state) {
    (void)state;
    hn_trial four_bar;
    hn_trial_open(&four_bar, FOUR_BAR);
    hn_run *run = hn_trial_run(&four_bar, "index1@rk4:h=0.02");
    const hn_incident *incidents = NULL;
    int told = 0, which = -1;
    assert_int_equal(hn_run_advance(run, 10), HN_OK);
    const int n = hn_run_incidents(run, &incidents);
    for (int i = 0; i < n; i++) {
        if (incidents[i].code == HN_INCIDENT_GAP_OPEN) {
            told++;
            which = i;
        }
    }
    assert_int_equal(told, 1); // the gap stays open from then on
    assert_true(incidents[which].value > incidents[which].limit);
    assert_near(incidents[which].t, 1.1, 0.3);
    hn_run *cured = hn_trial_run(&four_bar, incidents[which].remedy[0]);
    assert_int_equal(hn_run_advance(cured, 10), HN_OK);
    assert_true(hn_run_get_summary(cured).worst_gap < 1e-12);
    hn_run_free(cured);
    hn_run_free(run);
    hn_trial_close(&four_bar);
}

static void every_kind_of_incident_has_a_spelling_a_name_and_a_rule(void **state) {
    (void)state;
    const hn_incident_kind *const *kinds = hn_incident_kinds();
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        assert_int_equal(kinds[i]->code, i);
        assert_true(kinds[i]->spelling && kinds[i]->name && kinds[i]->rule);
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(kinds[i]->spelling, kinds[k]->spelling);
        }
    }
}

static void redundant_rows_are_told_and_give_the_same_motion(void **state) {
    (void)state;
    hn_trial twice;
    hn_trial_open(&twice, "tests/scenes/fb0-redundant.json");
    static const char *const spellings[] = {"index1@rk4:h=0.005", "projection@rk4:h=0.005",
                                            "nullspace@rk4:h=0.005", "partitioning@rk4:h=0.005",
                                            "reduced@rk4:h=0.005"};
    for (size_t i = 0; i < sizeof spellings / sizeof spellings[0]; i++) {
        hn_run *once = hn_trial_run(&trial, spellings[i]),
               *both = hn_trial_run(&twice, spellings[i]);
        const hn_incident *incidents = NULL;
        hn_sample a, b;
        assert_int_equal(hn_run_advance(once, 1), HN_OK);
        assert_int_equal(hn_run_advance(both, 1), HN_OK);
        assert_int_equal(hn_run_sample(once, 1, &a), HN_OK);
        assert_int_equal(hn_run_sample(both, 1, &b), HN_OK);
        assert_all_near(b.q, a.q, 3, 1e-11);
        assert_all_near(b.v, a.v, 3, 1e-11);
        assert_int_equal(b.rank, 2);
        assert_true(hn_run_incidents(both, &incidents) >= 1);
        assert_int_equal(incidents[0].code, HN_INCIDENT_RANK_LOSS);
        assert_int_equal(hn_run_incidents(once, &incidents), 0);
        hn_run_free(once);
        hn_run_free(both);
    }
    hn_trial_close(&twice);
}

static void the_budget_of_steps_ends_a_run_with_that_reason(void **state) {
    (void)state;
    static const char *const spellings[] = {"index1@rk4:h=1e-4", "index1@dopri5:rtol=1e-12"};
    for (int i = 0; i < 2; i++) {
        const hn_method_spec spec = hn_trial_spec(spellings[i]);
        hn_run_opts opts = hn_run_opts_default();
        hn_diag diag = {0};
        hn_run *run = NULL;
        const hn_incident *incidents = NULL;
        opts.max_steps = 50;
        assert_int_equal(hn_run_create(trial.sys, &spec, trial.q, trial.v, &opts, &run, &diag),
                         HN_OK);
        assert_int_equal(hn_run_advance(run, 10), HN_ERR_STOPPED);
        assert_true(hn_run_get_summary(run).steps <= 50);
        const int n = hn_run_incidents(run, &incidents);
        assert_int_equal(incidents[n - 1].code, HN_INCIDENT_STOPPED);
        hn_run_free(run);
    }
}

static void a_start_that_is_not_finite_is_refused(void **state) {
    (void)state;
    const hn_method_spec spec = hn_trial_spec("index1@rk4");
    hn_run *run = NULL;
    hn_diag diag = {0};
    hn_trial own; // the graph keeps tapes
    double q[3] = {1, nan(""), 0};
    const long live = hn_alloc_live();
    hn_trial_open(&own, FB0);
    assert_int_equal(hn_run_create(own.sys, &spec, q, own.v, NULL, &run, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.message, "finite"));
    hn_trial_close(&own);
    assert_int_equal(hn_alloc_live(), live);
}

static void settings_of_baumgarte_change_while_it_runs(void **state) {
    (void)state;
    hn_run *run = hn_trial_run(&trial, "baumgarte:alpha=0,beta=0@dopri5:rtol=1e-8");
    hn_diag diag = {0};
    char text[HN_SPEC_MAX];
    assert_int_equal(hn_run_advance(run, 0.5), HN_OK);
    assert_int_equal(hn_run_set(run, "alpha", 20, &diag), HN_OK);
    assert_int_equal(hn_run_set(run, "beta", 20, &diag), HN_OK);
    hn_method_format(hn_run_spec(run), text);
    assert_string_equal(text, "baumgarte:alpha=20,beta=20@dopri5:rtol=1e-08");
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_int_equal(hn_run_set(run, "alpah", 1, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.hint, "alpha"));
    assert_int_equal(hn_run_set(run, "alpha", 1e9, &diag), HN_ERR_INPUT);
    assert_int_equal(hn_run_set(run, "rtol", 1e-3, &diag), HN_ERR_UNSUPPORTED);
    hn_run_free(run);
}

static void an_adaptive_run_holds_its_tolerance_and_counts_rejections(void **state) {
    (void)state;
    hn_trial fast;
    hn_trial_open(&fast, FOUR_BAR);
    hn_run *loose = hn_trial_run(&fast, "projection@dopri5:rtol=1e-4,h0=0.5");
    hn_run *tight = hn_trial_run(&fast, "projection@dopri5:rtol=1e-10");
    assert_int_equal(hn_run_advance(loose, 2), HN_OK);
    assert_int_equal(hn_run_advance(tight, 2), HN_OK);
    const hn_run_summary a = hn_run_get_summary(loose), b = hn_run_get_summary(tight);
    assert_true(a.rejected > 0);
    assert_true(b.steps > 3 * a.steps);
    assert_true(b.worst_energy_change < 1e-3 * a.worst_energy_change);
    hn_run_free(loose);
    hn_run_free(tight);
    hn_trial_close(&fast);
}

static void a_step_that_nobody_looks_into_is_spared_the_slopes_of_dense_output(void **state) {
    (void)state;
    hn_trial fb0;
    hn_trial_open(&fb0, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_run *run = hn_trial_run(&fb0, "index1@dop853:rtol=1e-8");
    assert_int_equal(hn_run_advance(run, 2), HN_OK);
    const hn_run_summary s = hn_run_get_summary(run);
    // two for the first step size, 12 stages a step, 11 a rejected trial, four more slopes in the
    // last step
    assert_int_equal(s.cost.evals, 2 + 12 * s.steps + 11 * s.rejected + 4);
    hn_run_free(run);
    hn_trial_close(&fb0);
}

static void a_look_into_a_step_on_the_way_is_as_good_as_one_into_the_last(void **state) {
    (void)state;
    hn_trial fb0;
    hn_sample far, near;
    hn_trial_open(&fb0, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_run *on_the_way = hn_trial_run(&fb0, "index1@dop853:rtol=1e-8");
    hn_run *last = hn_trial_run(&fb0, "index1@dop853:rtol=1e-8");
    for (int i = 0; i < 10; i++) {
        assert_int_equal(hn_run_step_towards(on_the_way, 100), HN_OK);
        assert_int_equal(hn_run_step(last), HN_OK);
    }
    const double t = hn_run_time(last);
    assert_near(hn_run_time(on_the_way), t, 0); // the same steps
    assert_int_equal(hn_run_sample(on_the_way, t - 0.005, &far), HN_OK);
    assert_int_equal(hn_run_sample(last, t - 0.005, &near), HN_OK);
    assert_all_near(far.q, near.q, fb0.info.n_user, 1e-8); // the tolerance of a step
    hn_run_free(on_the_way);
    hn_run_free(last);
    hn_trial_close(&fb0);
}

static void memory_that_runs_out_while_a_run_is_made_is_told_and_given_back(void **state) {
    (void)state;
    static const char *const spellings[] = {"partitioning@dopri5", "projection@rk4"};
    const hn_method_spec specs[] = {hn_trial_spec(spellings[0]), hn_trial_spec(spellings[1])};
    for (int k = 0; k < 2; k++) {
        const long live = hn_alloc_live();
        long n = 1;
        for (int made = 0; !made; n++) {
            hn_trial fresh; // a graph that ran out of memory stays marked as failed
            hn_run *run = NULL;
            hn_diag diag = {0};
            hn_trial_open(&fresh, FB0);
            hn_alloc_fail_at(n);
            const hn_status status =
                hn_run_create(fresh.sys, &specs[k], fresh.q, fresh.v, NULL, &run, &diag);
            made = !hn_alloc_has_failed();
            hn_alloc_fail_at(0);
            assert_int_equal(status, made ? HN_OK : HN_ERR_MEMORY);
            hn_run_free(run);
            hn_trial_close(&fresh);
            assert_int_equal(hn_alloc_live(), live);
        }
        assert_true(n > 20);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(grid_times_are_exact_multiples_of_the_step, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(steps_and_samples_do_not_allocate, open_fb0, close_trial),
        cmocka_unit_test_setup_teardown(a_second_run_and_a_reset_give_the_same_bits, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(sampling_on_the_way_leaves_the_run_as_it_was, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(a_sample_between_steps_is_as_good_as_the_steps, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(interpolated_states_of_projection_are_closed, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(
            a_fixed_run_can_look_ahead_by_less_than_a_step_and_no_further, open_fb0, close_trial),
        cmocka_unit_test_setup_teardown(
            multipliers_and_accelerations_of_a_sample_are_those_of_the_saddle_system, open_fb0,
            close_trial),
        cmocka_unit_test_setup_teardown(a_diverged_run_keeps_its_last_good_state_and_its_reason,
                                        open_fb0, close_trial),
        cmocka_unit_test_setup_teardown(an_open_gap_is_told_once_with_a_remedy_that_closes_it,
                                        open_fb0, close_trial),
        cmocka_unit_test(every_kind_of_incident_has_a_spelling_a_name_and_a_rule),
        cmocka_unit_test_setup_teardown(redundant_rows_are_told_and_give_the_same_motion, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(the_budget_of_steps_ends_a_run_with_that_reason, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(a_start_that_is_not_finite_is_refused, open_fb0,
                                        close_trial),
        cmocka_unit_test_setup_teardown(settings_of_baumgarte_change_while_it_runs, open_fb0,
                                        close_trial),
        cmocka_unit_test(a_step_that_nobody_looks_into_is_spared_the_slopes_of_dense_output),
        cmocka_unit_test(a_look_into_a_step_on_the_way_is_as_good_as_one_into_the_last),
        cmocka_unit_test(memory_that_runs_out_while_a_run_is_made_is_told_and_given_back),
        cmocka_unit_test_setup_teardown(an_adaptive_run_holds_its_tolerance_and_counts_rejections,
                                        open_fb0, close_trial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
