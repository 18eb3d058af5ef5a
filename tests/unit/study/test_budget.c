// SPDX-License-Identifier: GPL-3.0-or-later
// The budget of a run adds up, and puts errors and energy where they are known to come from.

#include "study/budget/budget.h"
#include "support/model.h"
#include "support/near.h"
#include "support/trial.h"

#include <math.h>
#include <string.h>

static hn_budget budget_of(const hn_model *m, const char *method, double T) {
    const hn_method_spec spec = hn_trial_spec(method);
    hn_budget a;
    hn_diag diag = {0};
    const hn_status status = hn_budget_make(m->sys, &spec, m->q, m->v, T, NULL, &a, &diag);
    if (status != HN_OK) {
        fail_msg("%s: %s", method, diag.message);
    }
    return a;
}

static double sum_of_parts(const hn_budget *a) {
    double sum = 0;
    for (int i = 0; i < HN_ENERGY_COUNT; i++) {
        sum += a->energy_parts[i];
    }
    return sum;
}

static void parts_add_up_to_the_error_and_the_energy_of_every_kind_of_method(void **state) {
    (void)state;
    static const char *const methods[] = {
        "index1@rk4:h=1e-2",     "baumgarte@rk4:h=1e-2",
        "projection@rk4:h=1e-2", "projection@dopri5:rtol=1e-6",
        "nullspace@rk4:h=1e-2",  "reduced@rk4:h=1e-2",
        "penalty@rk4:h=1e-3",    "baumgarte@gsl-rk8pd:rtol=1e-5",
        "ggl@radau5:rtol=1e-6",  "ggl@ida:rtol=1e-7",
        "index3@rattle:h=1e-2",  "symmetric-projection@midpoint:h=1e-2"};
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        const hn_budget a = budget_of(&m, methods[i], 1);
        assert_int_equal(a.state, HN_RUN_FINISHED);
        // first order: what is left out is the square of the error, against a motion known to 1e-12
        assert_near(a.sum, a.error, 1e-3 * fabs(a.error) + 2e-12);
        assert_near(sum_of_parts(&a), a.energy, 1e-12 * a.swing);
        // nothing comes from outside where nothing acts from outside: flows are followed to 1e-14
        // in each of up to 1000 steps
        assert_true(a.conservative);
        assert_near(a.energy_parts[HN_ENERGY_OUTSIDE], 0, 1e-11 * a.swing);
    }
    hn_model_close(&m);
}

static void parts_add_up_through_many_loops_and_in_space(void **state) {
    (void)state;
    static const struct {
        const char *scene, *method;
        double T;
    } cases[] = {{"seven-body-squeezer", "index1@rk4:h=1e-4", 0.01},
                 {"stewart-6-6", "baumgarte@rk4:h=4e-3", 0.1},
                 {"stewart-6-6", "projection@dopri5:rtol=1e-6", 0.3},
                 {"delta-robot", "projection@rk4:h=4e-3", 0.2},
                 {"bennett", "index1@rk4:h=4e-3", 0.2}, // rows that depend on others
                 {"heavy-top", "index1@rk4:h=1e-3", 0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_model m;
        hn_model_open_closed(&m, cases[i].scene, NULL);
        const hn_budget a = budget_of(&m, cases[i].method, cases[i].T);
        hn_model_close(&m);
        // as above
        assert_near(a.sum, a.error, 1e-3 * fabs(a.error) + 2e-12);
        assert_true(fabs(a.error) > 1e-11);
        assert_near(sum_of_parts(&a), a.energy, 1e-12 * a.swing);
    }
}

static void what_is_left_out_is_of_second_order(void **state) {
    (void)state;
    double rest[2];
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (int i = 0; i < 2; i++) {
        const hn_budget a =
            budget_of(&m, i ? "projection@euler:h=5e-5" : "projection@euler:h=1e-4", 1);
        rest[i] = fabs(a.sum - a.error) / fabs(a.error);
    }
    hn_model_close(&m);
    assert_rel(rest[0] / rest[1], 2, 0.1); // relative: half the step, half the error, half the rest
}

static void the_printed_form_is_wrong_by_its_equations_and_not_by_its_steps(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    const hn_budget full = budget_of(&m, "nullspace@rk4:h=1e-2", 0.5),
                    printed = budget_of(&m, "nullspace-as-printed@rk4:h=1e-2", 0.5);
    hn_model_close(&m);
    // M_r' v_r is missing whatever the step: orders of magnitude more than RK4 leaves at this one
    assert_true(fabs(printed.part[HN_CAUSE_FORMULATION]) >
                1e4 * fabs(printed.part[HN_CAUSE_TRUNCATION]));
    assert_rel(printed.energy_parts[HN_ENERGY_FORMULATION], printed.energy, 1e-5);
    // the full form is the equations of motion: flows agree to rounding
    assert_near(full.part[HN_CAUSE_FORMULATION], 0, 1e-12);
    assert_near(full.energy_parts[HN_ENERGY_FORMULATION], 0, 1e-12 * full.swing);
}

static void drift_is_what_a_projection_would_have_spared(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    const hn_budget raw = budget_of(&m, "index1@rk4:h=1e-2", 1),
                    closed = budget_of(&m, "projection@rk4:h=1e-2", 1);
    hn_model_close(&m);
    // the same steps of the same integrator: along the loops' motion they do the same harm, to a
    // few parts in a thousand of it, because the states they start from are apart by the drift
    assert_rel(raw.part[HN_CAUSE_TRUNCATION], closed.part[HN_CAUSE_TRUNCATION], 5e-3);
    assert_rel(raw.part[HN_CAUSE_DRIFT], raw.error - closed.error, 5e-3);
    assert_near(closed.part[HN_CAUSE_DRIFT], 0, 1e-4 * fabs(raw.part[HN_CAUSE_DRIFT]));
}

static void what_explicit_euler_puts_in_is_of_first_order(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    const hn_budget coarse = budget_of(&m, "projection@euler:h=2e-4", 1),
                    fine = budget_of(&m, "projection@euler:h=1e-4", 1);
    hn_model_close(&m);
    // one order: half the step, half of what its steps put in
    assert_rel(coarse.energy_parts[HN_ENERGY_TRUNCATION] / fine.energy_parts[HN_ENERGY_TRUNCATION],
               2, 0.02);
}

static void drives_and_dampers_stand_as_outside(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "driven-crank", NULL);
    const hn_budget a = budget_of(&m, "projection@rk4:h=2e-3", 1);
    hn_model_close(&m);
    assert_false(a.conservative);
    assert_true(fabs(a.energy_parts[HN_ENERGY_OUTSIDE]) > 1e-3 * a.swing);
    assert_near(sum_of_parts(&a), a.energy, 1e-12 * a.swing);
    assert_near(a.energy_parts[HN_ENERGY_LOOPS], 0, 1e-10 * a.swing);
}

static void the_exact_motion_may_be_given_and_is_taken_for_the_end_asked_for_only(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_diag diag = {0};
    // one digit of it is wrong on purpose: the error is off by just that
    const hn_budget own = budget_of(&m, "projection@rk4:h=1e-2", 1);
    hn_run *run;
    hn_sample sample;
    const hn_method_spec tight = hn_trial_spec("projection@dop853:rtol=1e-13");
    double exact[8];
    assert_in_range(m.info.n_user, 1, 8);
    assert_int_equal(hn_run_create(m.sys, &tight, m.q, m.v, NULL, &run, &diag), HN_OK);
    assert_int_equal(hn_run_advance(run, 1), HN_OK);
    assert_int_equal(hn_run_sample(run, 1, &sample), HN_OK);
    memcpy(exact, sample.q, (size_t)m.info.n_user * sizeof *exact);
    hn_run_free(run);
    exact[own.coordinate] -= copysign(1e-3, own.error);
    const hn_budget_opts opts = {.exact = exact};
    hn_budget given, past;
    hn_method_spec spec = hn_trial_spec("projection@rk4:h=1e-2");
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, 1, &opts, &given, &diag), HN_OK);
    assert_int_equal(given.coordinate, own.coordinate);
    assert_near(given.error - own.error, copysign(1e-3, own.error), 1e-11);
    assert_near(given.sum, own.sum, 1e-15); // the parts are of the run alone
    // 0.03 does not divide 1: the run ends at 1.02, where what was given is not the motion
    spec = hn_trial_spec("projection@rk4:h=3e-2");
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, 1, &opts, &past, &diag), HN_OK);
    assert_near(past.t, 1.02, 1e-9);
    assert_near(past.sum, past.error, 1e-3 * fabs(past.error) + 2e-12);
    hn_model_close(&m);
}

static int stop_at_once(void *user) {
    (void)user;
    return 1;
}

static void what_cannot_be_accounted_for_is_told(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    const hn_method_spec spec = hn_trial_spec("index1@rk4:h=1e-3");
    hn_budget a;
    hn_diag diag = {0};
    hn_budget_opts opts = {.max_steps = 10};
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, 1, &opts, &a, &diag), HN_ERR_LIMIT);
    assert_non_null(strstr(diag.message, "10 steps"));
    opts = (hn_budget_opts){.stop = stop_at_once};
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, 1, &opts, &a, &diag), HN_ERR_STOPPED);
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, -1, NULL, &a, &diag), HN_ERR_INPUT);
    hn_model_close(&m);
}

static void a_run_that_fails_keeps_its_energy_budget_and_has_no_error_at_the_end(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "double-rocker", NULL);
    const hn_budget a = budget_of(&m, "reduced@rk4:h=1e-3", 1); // th1 turns back at 0.653 s
    hn_model_close(&m);
    assert_int_equal(a.state, HN_RUN_FAILED);
    assert_true(a.reason[0] != 0 && a.t < 0.66 && a.steps > 600);
    assert_int_equal(a.coordinate, -1);
    assert_near(sum_of_parts(&a), a.energy, 1e-12 * a.swing);
}

static void past_a_pose_that_loses_rank_there_is_no_budget_and_the_pose_is_told(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", NULL); // all links in one line first at 0.71 s
    const hn_budget before = budget_of(&m, "projection@rk4:h=4e-3", 0.4);
    const hn_method_spec spec = hn_trial_spec("projection@rk4:h=4e-3");
    hn_budget past;
    hn_diag diag = {0};
    assert_int_equal(hn_budget_make(m.sys, &spec, m.q, m.v, 1, NULL, &past, &diag),
                     HN_ERR_NO_CONVERGENCE);
    hn_model_close(&m);
    // in the step that goes across it, whatever the size of steps that the flow before it had found
    assert_non_null(strstr(diag.message, "beside the step from t = 0.712 to 0.716 s"));
    assert_non_null(
        strstr(diag.message,
               "near t = 0.712 s the constraints become almost dependent (J almost loses rank)"));
    assert_true(before.coordinate >= 0);
    // the error is some 1e-10, against a motion known to 1e-12
    assert_near(before.sum, before.error, 1e-3 * fabs(before.error) + 2e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_add_up_to_the_error_and_the_energy_of_every_kind_of_method),
        cmocka_unit_test(parts_add_up_through_many_loops_and_in_space),
        cmocka_unit_test(what_is_left_out_is_of_second_order),
        cmocka_unit_test(the_printed_form_is_wrong_by_its_equations_and_not_by_its_steps),
        cmocka_unit_test(drift_is_what_a_projection_would_have_spared),
        cmocka_unit_test(what_explicit_euler_puts_in_is_of_first_order),
        cmocka_unit_test(drives_and_dampers_stand_as_outside),
        cmocka_unit_test(the_exact_motion_may_be_given_and_is_taken_for_the_end_asked_for_only),
        cmocka_unit_test(what_cannot_be_accounted_for_is_told),
        cmocka_unit_test(past_a_pose_that_loses_rank_there_is_no_budget_and_the_pose_is_told),
        cmocka_unit_test(a_run_that_fails_keeps_its_energy_budget_and_has_no_error_at_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
