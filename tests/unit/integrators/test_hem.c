// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "support/dae.h"
#include "support/near.h"
#include "support/odes.h"

#include <math.h>

#define ORDER_TOL 0.15

static hn_model fb0;
static hn_test_state exact;
#define T_END 1.0

static int setup(void **state) {
    (void)state;
    hn_model_open_closed(&fb0, "fb0", NULL);
    hn_test_reference(&fb0, T_END, &exact);
    return 0;
}

static int teardown(void **state) {
    (void)state;
    hn_model_close(&fb0);
    return 0;
}

static hn_test_orders orders_of(const char *name) {
    return hn_test_dae_orders(&fb0, hn_stepper_find(name), HN_FORM_INDEX2, NULL, T_END, 100, 4,
                              &exact);
}

static void the_reference_of_these_tests_is_the_published_state(void **state) {
    (void)state;
    double user[3];
    hn_system_to_user(fb0.sys, exact.q, user);
    assert_near(user[hn_model_user(&fb0, "th1")], 2.72677524435375, 1e-12);
    hn_system_rates_to_user(fb0.sys, exact.v, user);
    assert_near(user[hn_model_user(&fb0, "th1")], 4.16807616253500, 1e-11);
}

static void each_scheme_has_its_order_in_positions_speeds_and_recomputed_multipliers(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double order;
    } table[] = {{"hem3", 3}, {"hem4", 4}, {"half-explicit-rk4", 3}};
    for (int i = 0; i < 3; i++) {
        const hn_test_orders o = orders_of(table[i].name);
        assert_near(o.q, table[i].order, ORDER_TOL);
        assert_near(o.v, table[i].order, ORDER_TOL);
        assert_near(o.lambda, table[i].order, ORDER_TOL);
        assert_near(hn_stepper_find(table[i].name)->order, table[i].order, 0);
    }
}

static void speeds_fit_the_loop_to_rounding_while_positions_drift_with_the_error(void **state) {
    (void)state;
    const hn_test_orders o = orders_of("hem3");
    // speeds of 10 m/s: a few roundings
    assert_true(o.worst_speed_gap < 1e-14);
    assert_true(o.worst_gap > 1e-9);
    assert_true(o.worst_gap < 1e-3);
}

static void a_free_pendulum_is_integrated_by_the_plain_tableau(void **state) {
    (void)state;
    hn_model m;
    hn_test_state end;
    hn_model_open_closed(&m, "pendulum", NULL);
    hn_test_reference(&m, T_END, &end);
    // without constraints the classical tableau is of order 4 again
    const hn_test_orders o = hn_test_dae_orders(&m, hn_stepper_find("half-explicit-rk4"),
                                                HN_FORM_INDEX2, NULL, T_END, 40, 4, &end);
    assert_near(o.q, 4, 0.2);
    hn_model_close(&m);
}

static void step_doubling_estimates_the_error_of_the_step(void **state) {
    (void)state;
    // one step of 0.02 against the state by many small ones
    hn_test_dae coarse, fine;
    double ratio_least = HUGE_VAL, ratio_most = 0;
    hn_test_dae_open(&coarse, &fb0, hn_stepper_find("hem4-adaptive"), HN_FORM_INDEX2, NULL);
    hn_test_dae_open(&fine, &fb0, hn_stepper_find("hem4"), HN_FORM_INDEX2, NULL);
    assert_int_equal(hn_test_dae_steps(&coarse, 0.02, 1), HN_OK);
    assert_int_equal(hn_test_dae_steps(&fine, 0.02 / 64, 64), HN_OK);
    for (int i = 0; i < fb0.info.nq; i++) {
        const double ratio = fabs(coarse.err[i]) / fabs(coarse.y[i] - fine.y[i]);
        ratio_least = fmin(ratio_least, ratio);
        ratio_most = fmax(ratio_most, ratio);
    }
    assert_true(ratio_least > 0.7);
    assert_true(ratio_most < 1.4);
    hn_test_dae_close(&coarse);
    hn_test_dae_close(&fine);
}

static void a_trial_step_can_be_repeated_with_another_size(void **state) {
    (void)state;
    static const char *const names[] = {"hem3", "hem4", "hem4-adaptive", "half-explicit-rk4"};
    for (int k = 0; k < 4; k++) {
        hn_test_dae once, twice;
        const hn_stepper *s = hn_stepper_find(names[k]);
        hn_test_dae_open(&once, &fb0, s, HN_FORM_INDEX2, NULL);
        hn_test_dae_open(&twice, &fb0, s, HN_FORM_INDEX2, NULL);
        assert_int_equal(s->dae->step(twice.self, 0, 0.05, twice.y, twice.y_new, twice.err), HN_OK);
        assert_int_equal(hn_test_dae_steps(&once, 0.01, 3), HN_OK);
        assert_int_equal(hn_test_dae_steps(&twice, 0.01, 3), HN_OK);
        assert_memory_equal(once.y, twice.y, sizeof *once.y * (size_t)(fb0.info.nq + fb0.info.nv));
        hn_test_dae_close(&once);
        hn_test_dae_close(&twice);
    }
}

static void rows_written_twice_change_nothing_but_the_last_digits(void **state) {
    (void)state;
    hn_model twice;
    hn_test_dae a, b;
    hn_model_open_closed(&twice, "fb0-redundant", NULL);
    assert_true(twice.info.nc > fb0.info.nc);
    hn_test_dae_open(&a, &fb0, hn_stepper_find("hem4"), HN_FORM_INDEX2, NULL);
    hn_test_dae_open_as(&b, &twice, hn_stepper_find("hem4"), hn_formulation_find("index2"),
                        "close=-1", NULL);
    assert_int_equal(hn_test_dae_steps(&a, 0.01, 100), HN_OK);
    assert_int_equal(hn_test_dae_steps(&b, 0.01, 100), HN_OK);
    double user_a[8], user_b[8];
    hn_system_to_user(fb0.sys, a.y, user_a);
    hn_system_to_user(twice.sys, b.y, user_b);
    assert_near(user_a[hn_model_user(&fb0, "th1")], user_b[hn_model_user(&twice, "th1")], 1e-12);
    hn_test_dae_close(&a);
    hn_test_dae_close(&b);
    hn_model_close(&twice);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_of_these_tests_is_the_published_state),
        cmocka_unit_test(each_scheme_has_its_order_in_positions_speeds_and_recomputed_multipliers),
        cmocka_unit_test(speeds_fit_the_loop_to_rounding_while_positions_drift_with_the_error),
        cmocka_unit_test(a_free_pendulum_is_integrated_by_the_plain_tableau),
        cmocka_unit_test(step_doubling_estimates_the_error_of_the_step),
        cmocka_unit_test(a_trial_step_can_be_repeated_with_another_size),
        cmocka_unit_test(rows_written_twice_change_nothing_but_the_last_digits),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
