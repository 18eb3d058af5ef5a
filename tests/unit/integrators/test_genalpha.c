// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"
#include "support/dae.h"
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "integrators/list/stepper_list.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

#define ORDER_TOL 0.15
#define T_END 1.0

static hn_model fb0, point; // M(q) in angles; constant M in Cartesian coordinates
static hn_test_state fb0_end, point_end;

static int setup(void **state) {
    (void)state;
    hn_model_open_closed(&fb0, "fb0", NULL);
    hn_test_reference(&fb0, T_END, &fb0_end);
    hn_model_open_closed(&point, "circle-particle", NULL);
    hn_test_reference(&point, T_END, &point_end);
    return 0;
}

static int teardown(void **state) {
    (void)state;
    hn_model_close(&fb0);
    hn_model_close(&point);
    return 0;
}

static hn_test_orders on_fb0(const char *name, hn_dae_form form, const char *options) {
    return hn_test_dae_orders(&fb0, hn_stepper_find(name), form, options, T_END, 100, 4, &fb0_end);
}

static void order_is_2_in_positions_speeds_and_multipliers_below_rho_1(void **state) {
    (void)state;
    static const char *const options[] = {"rho=0.9", "rho=0.8", "rho=0.5", "a0=consistent"};
    for (int i = 0; i < 4; i++) {
        const hn_test_orders o = on_fb0("genalpha", HN_FORM_INDEX3, options[i]);
        assert_near(o.q, 2, ORDER_TOL);
        assert_near(o.v, 2, ORDER_TOL);
        assert_near(o.lambda, 2, ORDER_TOL);
        assert_near(o.raw, 2, ORDER_TOL);
        assert_true(o.worst_gap < 5e-15);
        assert_true(o.worst_speed_gap > 1e-6); // positions alone are asked for
    }
}

static void multipliers_of_its_own_do_not_converge_at_rho_1(void **state) {
    (void)state;
    const hn_test_orders o = on_fb0("genalpha", HN_FORM_INDEX3, "rho=1");
    assert_near(o.q, 2, ORDER_TOL);
    assert_near(o.v, 2, ORDER_TOL);
    // recomputed from the state they are fine, which is why those are told
    assert_near(o.lambda, 2, ORDER_TOL);
    assert_near(o.raw, 0, ORDER_TOL);
    assert_true(o.err_raw[3] > 10);
}

static void a_start_from_zero_acceleration_costs_an_order_in_everything(void **state) {
    (void)state;
    static const hn_dae_form forms[] = {HN_FORM_INDEX3, HN_FORM_GGL};
    for (int i = 0; i < 2; i++) {
        const hn_test_orders zero = on_fb0("genalpha", forms[i], "a0=zero");
        const hn_test_orders good = on_fb0("genalpha", forms[i], NULL);
        assert_near(zero.q, 1, ORDER_TOL);
        assert_near(zero.v, 1, ORDER_TOL);
        assert_near(zero.raw, 1, ORDER_TOL);
        assert_true(zero.err_q[2] > 100 * good.err_q[2]);
    }
}

static void stabilised_form_keeps_positions_and_speeds_at_rounding_and_order_2(void **state) {
    (void)state;
    const hn_test_orders o = on_fb0("genalpha", HN_FORM_GGL, NULL);
    assert_near(o.q, 2, ORDER_TOL);
    assert_near(o.v, 2, ORDER_TOL);
    assert_near(o.raw, 2, ORDER_TOL);
    assert_true(o.worst_gap < 5e-15);
    assert_true(o.worst_speed_gap < 1e-14);
}

static void hht_is_of_order_2_for_a_constant_mass_and_little_more_than_1_in_angles(void **state) {
    (void)state;
    static const char *const options[] = {"damping=0.05", "damping=0.3"};
    for (int i = 0; i < 2; i++) {
        const hn_test_orders constant = hn_test_dae_orders(
            &point, hn_stepper_find("hht"), HN_FORM_INDEX3, options[i], T_END, 100, 4, &point_end);
        assert_near(constant.q, 2, ORDER_TOL);
        assert_near(constant.v, 2, ORDER_TOL);
        assert_near(constant.raw, 2, ORDER_TOL);
        const hn_test_orders turning = on_fb0("hht", HN_FORM_INDEX3, options[i]);
        assert_near(turning.q, 1.1, ORDER_TOL);
        assert_near(turning.v, 1.1, ORDER_TOL);
    }
}

static void speeds_that_do_not_fit_the_loop_give_a_blow_of_size_1_over_h(void **state) {
    (void)state;
    double blow[3];
    for (int i = 0; i < 3; i++) {
        hn_test_dae d;
        const double h = 0.01 / (1 << i);
        double v[3];
        memcpy(v, fb0.v, sizeof v);
        fb0.v[2] += 1; // the rocker alone: its tip parts from the coupler's
        hn_test_dae_open(&d, &fb0, hn_stepper_find("genalpha"), HN_FORM_INDEX3, NULL);
        assert_int_equal(hn_test_dae_steps(&d, h, 1), HN_OK);
        blow[i] = h * hn_norm2(fb0.info.nc, d.table->raw_lambda(d.self));
        hn_test_dae_close(&d);
        memcpy(fb0.v, v, sizeof v);
    }
    assert_true(blow[0] > 0.1);
    assert_rel(blow[1], blow[0], 0.03);
    assert_rel(blow[2], blow[1], 0.03);
}

// x'' + w^2 x = 0 beside nothing else: after many steps at h w = 1000 what is left falls by rho a
// step
static void an_infinitely_fast_oscillation_keeps_rho_of_itself_in_a_step(void **state) {
    (void)state;
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"spring\", \"lagrangian\": {\"coordinates\": ["
        "{\"name\": \"x\", \"rate\": \"v\", \"unit\": \"m\"}], \"kinetic\": \"v^2/2\","
        "\"potential\": \"0.5*1e6*x^2\"}, \"start\": {\"positions\": {\"x\": 1e-3}, \"rates\": "
        "{\"v\": 0}}}";
    static const struct {
        const char *options;
        double rho;
    } table[] = {{"rho=0.3 a0=consistent", 0.3}, {"rho=0.8 a0=consistent", 0.8}};
    hn_model m;
    hn_model_open_text(&m, text, NULL);
    for (int i = 0; i < 2; i++) {
        hn_test_dae d;
        hn_test_dae_open(&d, &m, hn_stepper_find("genalpha"), HN_FORM_INDEX3, table[i].options);
        assert_int_equal(hn_test_dae_steps(&d, 1, 100), HN_OK);
        const double early = hn_norm2(1, d.y);
        assert_int_equal(hn_test_dae_steps(&d, 1, 100), HN_OK);
        // roots of size rho nearly fall together, so powers of n stand beside rho^n: 2^(2/100), and
        // a beat
        const double rate = pow(hn_norm2(1, d.y) / early, 1.0 / 100);
        assert_rel(rate, table[i].rho, 0.05);
        hn_test_dae_close(&d);
    }
    hn_model_close(&m);
}

static void rows_written_twice_change_nothing_but_the_last_digits(void **state) {
    (void)state;
    static const hn_dae_form forms[] = {HN_FORM_INDEX3, HN_FORM_GGL};
    hn_model twice;
    hn_model_open_closed(&twice, "fb0-redundant", NULL);
    for (int i = 0; i < 2; i++) {
        hn_test_dae a, b;
        double user_a[8], user_b[8];
        hn_test_dae_open(&a, &fb0, hn_stepper_find("genalpha"), forms[i], NULL);
        hn_test_dae_open(&b, &twice, hn_stepper_find("genalpha"), forms[i], NULL);
        assert_int_equal(hn_test_dae_steps(&a, 0.01, 100), HN_OK);
        assert_int_equal(hn_test_dae_steps(&b, 0.01, 100), HN_OK);
        hn_system_to_user(fb0.sys, a.y, user_a);
        hn_system_to_user(twice.sys, b.y, user_b);
        assert_near(user_a[hn_model_user(&fb0, "th1")], user_b[hn_model_user(&twice, "th1")],
                    1e-11);
        hn_test_dae_close(&a);
        hn_test_dae_close(&b);
    }
    hn_model_close(&twice);
}

static void a_step_does_not_allocate_and_a_trial_can_be_repeated(void **state) {
    (void)state;
    static const struct {
        const char *name;
        hn_dae_form form;
    } table[] = {{"genalpha", HN_FORM_INDEX3}, {"genalpha", HN_FORM_GGL}, {"hht", HN_FORM_INDEX3}};
    for (int k = 0; k < 3; k++) {
        hn_test_dae once, twice;
        const hn_stepper *s = hn_stepper_find(table[k].name);
        hn_test_dae_open(&once, &fb0, s, table[k].form, NULL);
        hn_test_dae_open(&twice, &fb0, s, table[k].form, NULL);
        const long before = hn_alloc_count();
        assert_int_equal(s->dae->step(twice.self, 0, 0.05, twice.y, twice.y_new, twice.err), HN_OK);
        assert_int_equal(hn_test_dae_steps(&once, 0.01, 3), HN_OK);
        assert_int_equal(hn_test_dae_steps(&twice, 0.01, 3), HN_OK);
        assert_int_equal(hn_alloc_count(), before);
        assert_memory_equal(once.y, twice.y, sizeof *once.y * (size_t)(fb0.info.nq + fb0.info.nv));
        hn_test_dae_close(&once);
        hn_test_dae_close(&twice);
    }
}

// x^2 + y^2 = 1 holds y, which has no mass, to x: the motion is determined, M^-1 does not exist
static void
a_massless_coordinate_is_refused_by_name_where_the_stabiliser_divides_by_masses(void **state) {
    (void)state;
    static const char light[] =
        "{\"holonom\": 1, \"name\": \"light\", \"lagrangian\": {\"coordinates\": ["
        "{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", "
        "\"unit\": \"m\"}], \"kinetic\": \"vx^2/2\", \"potential\": \"9.81*y\","
        "\"constraints\": [{\"name\": \"rod\", \"formula\": \"x^2 + y^2 - 1\"}]},"
        "\"start\": {\"positions\": {\"x\": 0.6, \"y\": {\"guess\": -0.8}}, \"rates\": {\"x\": "
        "0}}}";
    static const char *const steppers[] = {"genalpha", "radau5", "radau3"};
    for (int i = 0; i < 3; i++) {
        const hn_stepper *s = hn_stepper_find(steppers[i]);
        hn_model m;
        hn_test_dae d;
        hn_model_open_text(&m, light, NULL);
        hn_test_dae_open(&d, &m, s, HN_FORM_GGL, NULL);
        assert_int_not_equal(hn_test_dae_steps(&d, 1e-3, 1), HN_OK);
        assert_non_null(strstr(d.table->why(d.self), "y moves no mass"));
        hn_test_dae_close(&d);
        hn_test_dae_open(&d, &m, s, HN_FORM_INDEX3, NULL);
        assert_int_equal(hn_test_dae_steps(&d, 1e-3, 10),
                         HN_OK); // what it is told to use serves it
        hn_test_dae_close(&d);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_2_in_positions_speeds_and_multipliers_below_rho_1),
        cmocka_unit_test(multipliers_of_its_own_do_not_converge_at_rho_1),
        cmocka_unit_test(a_start_from_zero_acceleration_costs_an_order_in_everything),
        cmocka_unit_test(stabilised_form_keeps_positions_and_speeds_at_rounding_and_order_2),
        cmocka_unit_test(hht_is_of_order_2_for_a_constant_mass_and_little_more_than_1_in_angles),
        cmocka_unit_test(speeds_that_do_not_fit_the_loop_give_a_blow_of_size_1_over_h),
        cmocka_unit_test(an_infinitely_fast_oscillation_keeps_rho_of_itself_in_a_step),
        cmocka_unit_test(rows_written_twice_change_nothing_but_the_last_digits),
        cmocka_unit_test(a_step_does_not_allocate_and_a_trial_can_be_repeated),
        cmocka_unit_test(
            a_massless_coordinate_is_refused_by_name_where_the_stabiliser_divides_by_masses),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
