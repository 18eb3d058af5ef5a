// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/trial.h"

#include "study/truth/reference.h"

#include <math.h>
#include <string.h>

static hn_ref *reference_of(const hn_trial *trial, double T) {
    hn_ref *ref = NULL;
    hn_diag diag = {0};
    if (hn_ref_create(trial->sys, trial->q, trial->v, T, NULL, &ref, &diag) != HN_OK) {
        fail_msg("%s", diag.message);
    }
    return ref;
}

// th1, th2, th3, w1 of FB0 at t = 2: one-coordinate equation by extrapolation in 30-digit
// arithmetic
static void the_reference_four_bar_has_the_digits_it_claims(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_ref *ref = reference_of(&trial, 2);
    const double known[3] = {7.41136679869211579, 0.464690378889553311, 1.56178258771354034};
    const hn_state_seen end = hn_ref_at(ref, ref->n);
    assert_true(hn_ref_digits(ref) > 14);
    for (int i = 0; i < 3; i++) {
        // the two could err alike: twice their difference, and rounding of an angle of 7 rad
        assert_near(end.q[i], known[i], 2 * ref->error[HN_ERROR_Q] + 2e-15);
    }
    assert_near(end.v[0], 1.57149060850687302,
                2 * ref->error[HN_ERROR_V] * ref->scales.rate + 1e-13);
    // lambda to the 13 digits that are known of it
    assert_near(end.lambda[0], -0.4306137880871, 1e-11);
    assert_near(end.lambda[1], 6.9445833305829, 1e-11);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void the_two_computations_share_neither_formulation_nor_integrator(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "slider-crank.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    assert_string_equal(ref->means[0], "saddle@extrapolation in long double");
    assert_string_equal(ref->means[1], "nullspace@gauss10 in long double");
    assert_true(ref->error[HN_ERROR_Q] >= 1.1e-16); // half a unit in the last place of 1
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

// a pendulum of length 1 let go at rest from the horizontal: its energy stays, its rate follows
// from it
static void a_pendulum_keeps_its_energy_along_the_reference(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "pendulum.json");
    hn_ref *ref = reference_of(&trial, 2);
    for (int k = 0; k <= ref->n; k++) {
        assert_near(ref->energy[k], ref->energy[0], 1e-11 * ref->scales.energy);
    }
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

// without a motion there is nothing to divide by, and nothing to get wrong
static void a_scene_at_rest_has_finite_errors(void **state) {
    (void)state;
    hn_trial trial;
    const hn_setting none = {"g", 0};
    hn_trial_open_with(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json", &none, 1);
    memset(trial.v, 0, sizeof trial.v);
    hn_ref *ref = reference_of(&trial, 0.1);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        assert_near(ref->error[i], 0, 1e-13);
    }
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

// a whole turn is an error of a turn: angles are never taken modulo one
static void a_whole_turn_counts_as_an_error(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_ref *ref = reference_of(&trial, 0.1);
    hn_arena *arena = hn_arena_create(0);
    hn_errors *errors = NULL;
    assert_int_equal(hn_errors_create(trial.sys, arena, &errors), HN_OK);
    hn_state_seen at = hn_ref_at(ref, ref->n), turned = at;
    double q[3] = {at.q[0] + 2 * 3.14159265358979, at.q[1], at.q[2]}, e[HN_ERROR_COUNT];
    turned.q = q;
    hn_errors_calc(errors, &turned, &at, &ref->scales, e);
    assert_near(e[HN_ERROR_Q], 2 * 3.14159265358979, 1e-12);
    assert_near(e[HN_ERROR_V], 0, 0);
    hn_errors_free(errors);
    hn_arena_free(arena);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

/// Error of the reactions when multipliers i and j are changed by 1 and `other`.
static double reaction_error(hn_errors *errors, const hn_ref *ref, int i, int j, double other) {
    const hn_state_seen at = hn_ref_at(ref, ref->n);
    hn_state_seen changed = at;
    double lambda[16], e[HN_ERROR_COUNT];
    memcpy(lambda, at.lambda, (size_t)ref->nc * sizeof(double));
    lambda[i] += 1;
    lambda[j] += other;
    changed.lambda = lambda;
    hn_errors_calc(errors, &changed, &at, &ref->scales, e);
    return e[HN_ERROR_REACTION];
}

// the rows of the loop written twice: what one row takes from its copy no body feels
static void multipliers_that_no_body_feels_are_no_error(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "tests/scenes/fb0-redundant.json");
    hn_ref *ref = reference_of(&trial, 0.1);
    hn_arena *arena = hn_arena_create(0);
    hn_errors *errors = NULL;
    assert_int_equal(hn_errors_create(trial.sys, arena, &errors), HN_OK);
    assert_true(ref->error[HN_ERROR_REACTION] < 1e-8);
    int unfelt = 0;
    for (int i = 0; i < ref->nc; i++) {
        assert_true(reaction_error(errors, ref, i, i, 0) > 1e-3);
        for (int j = 0; j < i; j++) {
            unfelt += reaction_error(errors, ref, i, j, -1) < 1e-13;
        }
    }
    assert_true(unfelt >= 1);
    hn_errors_free(errors);
    hn_arena_free(arena);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static int at_once(void *user) {
    (void)user;
    return 1;
}

// what takes over where extended precision does not get to the end
static void in_double_two_formulations_and_two_integrators_agree(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_ref *ref = NULL;
    hn_diag diag = {0};
    hn_ref_opts opts = hn_ref_opts_default();
    opts.skip_precise = 1;
    assert_int_equal(hn_ref_create(trial.sys, trial.q, trial.v, 1, &opts, &ref, &diag), HN_OK);
    const hn_method_spec a = hn_trial_spec(ref->means[0]), b = hn_trial_spec(ref->means[1]);
    assert_ptr_not_equal(a.formulation, b.formulation);
    assert_ptr_not_equal(a.stepper, b.stepper);
    assert_true(hn_ref_digits(ref) > 11);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void a_reference_that_is_stopped_or_out_of_time_says_so(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    hn_ref *ref = NULL;
    hn_diag diag = {0};
    hn_ref_opts opts = hn_ref_opts_default();
    opts.limits.stop = at_once;
    assert_int_equal(hn_ref_create(trial.sys, trial.q, trial.v, 50, &opts, &ref, &diag),
                     HN_ERR_STOPPED);
    opts = hn_ref_opts_default();
    opts.limits.seconds = 1e-9;
    assert_int_equal(hn_ref_create(trial.sys, trial.q, trial.v, 50, &opts, &ref, &diag),
                     HN_ERR_NO_CONVERGENCE);
    assert_non_null(strstr(diag.message, "takes more than"));
    assert_int_equal(hn_ref_create(trial.sys, trial.q, trial.v, -1, NULL, &ref, &diag),
                     HN_ERR_INPUT);
    assert_null(ref);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_four_bar_has_the_digits_it_claims),
        cmocka_unit_test(the_two_computations_share_neither_formulation_nor_integrator),
        cmocka_unit_test(a_pendulum_keeps_its_energy_along_the_reference),
        cmocka_unit_test(a_scene_at_rest_has_finite_errors),
        cmocka_unit_test(a_whole_turn_counts_as_an_error),
        cmocka_unit_test(multipliers_that_no_body_feels_are_no_error),
        cmocka_unit_test(in_double_two_formulations_and_two_integrators_agree),
        cmocka_unit_test(a_reference_that_is_stopped_or_out_of_time_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
