// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/order_runs.h"
#include "support/trial.h"

#include "formulations/list/formulation_list.h"
#include "study/cost/convergence.h"

#include <math.h>
#include <stdio.h>

static void the_fit_of_a_power_law_is_its_exponent(void **state) {
    (void)state;
    const double x[4] = {1, 0.5, 0.25, 0.125}, y[4] = {3, 0.75, 0.1875, 0.046875};
    assert_near(hn_fit_order(4, x, y), 2, 1e-13);
}

static void points_without_a_logarithm_are_left_out(void **state) {
    (void)state;
    const double x[4] = {1, 0.5, 0.25, 0.125}, y[4] = {nan(""), 0.5, 0, 0.125};
    assert_near(hn_fit_order(4, x, y), 1, 1e-13);
    assert_true(isnan(hn_fit_order(1, x, x)));
    assert_true(isnan(hn_fit_order(2, x, y)));
}

// th1, th2, th3 of FB0 at t = 1: two independent solutions agree on these digits
static const double reference_q[3] = {2.72677524435375, 0.43412079439446, 2.37837623328494};

static double order_of(const hn_trial *trial, const char *spelling, int n) {
    const hn_method_spec spec = hn_trial_spec(spelling);
    hn_order_runs runs;
    hn_order_runs_make(trial->sys, &spec, trial->q, trial->v, 1, n, reference_q, 2e-13, &runs);
    return runs.order;
}

static void every_sound_method_has_the_order_of_its_integrator_on_a_closed_loop(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    static const struct {
        const char *integrator;
        int n;
        double order;
    } rows[] = {{"euler:h=1e-3", 4, 1},
                {"symplectic-euler:h=1e-3", 4, 1},
                {"heun:h=4e-3", 4, 2},
                {"verlet:h=4e-3", 4, 2},
                {"rk4:h=1.25e-2", 5, 4}};
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        for (size_t k = 0;
             k < sizeof rows / sizeof rows[0] && !f->model_error && f->form == HN_FORM_ODE; k++) {
            char spelling[HN_SPEC_MAX];
            snprintf(spelling, sizeof spelling, "%s@%s", f->name, rows[k].integrator);
            const double order = order_of(&trial, spelling, rows[k].n);
            if (!(fabs(order - rows[k].order) <= 0.3)) {
                fail_msg("%s: order %.3f", spelling, order);
            }
        }
    }
    hn_trial_close(&trial);
}

static void the_printed_null_space_form_does_not_converge(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    assert_near(order_of(&trial, "nullspace-as-printed@rk4:h=1e-2", 4), 0, 0.01);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fit_of_a_power_law_is_its_exponent),
        cmocka_unit_test(points_without_a_logarithm_are_left_out),
        cmocka_unit_test(every_sound_method_has_the_order_of_its_integrator_on_a_closed_loop),
        cmocka_unit_test(the_printed_null_space_form_does_not_converge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
