#include "support/alloc.h"
#include "support/dae.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

#define ORDER_TOL 0.1

// a bob of 1 kg on a rod of 1 m, level at the start
#define BOB(forces)                                                                              \
    "{\"holonom\": 1, \"name\": \"bob\", \"lagrangian\": {\"coordinates\": ["                    \
    "{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", " \
    "\"unit\": \"m\"}], \"kinetic\": \"(vx^2 + vy^2)/2\", \"potential\": \"9.81*y\"," forces     \
    "\"constraints\": [{\"name\": \"rod\", \"formula\": \"x^2 + y^2 - 1\"}]},"                   \
    "\"start\": {\"positions\": {\"x\": 1, \"y\": {\"guess\": 0}}, \"rates\": {\"vy\": 0}}}"
static const char bob[] = BOB("");
static const char damped_bob[] = BOB("\"forces\": {\"x\": \"-0.7*vx\", \"y\": \"-0.7*vy\"},");
#define BOB_ENERGY 0.0

static const hn_stepper *rattle(void) {
    return hn_stepper_find("rattle");
}

static void check_order_2(const hn_model *m, const char *settings) {
    hn_test_state exact;
    hn_test_reference(m, 1, &exact);
    const hn_test_orders o =
        hn_test_dae_orders(m, rattle(), HN_FORM_INDEX3, settings, 1, 100, 4, &exact);
    assert_near(o.q, 2, ORDER_TOL);
    assert_near(o.v, 2, ORDER_TOL);
    assert_near(o.lambda, 2, ORDER_TOL);
    assert_near(o.raw, 1, ORDER_TOL); // one-sided: see rattle.c
    assert_true(o.worst_gap < 5e-15);
    assert_true(o.worst_speed_gap < 1e-14);
}

static void order_is_2_with_a_mass_that_turns_with_the_links(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    check_order_2(&m, NULL);
    hn_model_close(&m);
}

static void order_is_2_with_a_constant_mass(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, bob, NULL);
    check_order_2(&m, NULL);
    hn_model_close(&m);
}

static void a_damper_is_refused_with_the_way_to_take_it(void **state) {
    (void)state;
    hn_model m;
    hn_diag diag = {0};
    void *self = NULL;
    const double settings[HN_MAX_SETTINGS] = {1e-3, 0}, none[HN_MAX_SETTINGS] = {0};
    hn_arena *arena = hn_arena_create(0);
    hn_model_open_text(&m, damped_bob, NULL);
    assert_int_equal(
        rattle()->dae->create(m.sys, HN_FORM_INDEX3, settings, none, arena, &self, &diag),
        HN_ERR_UNSUPPORTED);
    assert_non_null(strstr(diag.message, "speed"));
    assert_non_null(strstr(diag.hint, "split"));
    if (self) {
        rattle()->dae->destroy(self);
    }
    hn_arena_free(arena);
    hn_model_close(&m);
}

static void order_is_2_with_a_damper_split_off(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_text(&m, damped_bob, NULL);
    hn_test_state exact;
    hn_test_reference(&m, 1, &exact);
    const hn_test_orders o =
        hn_test_dae_orders(&m, rattle(), HN_FORM_INDEX3, "speed-forces=split", 1, 100, 4, &exact);
    assert_near(o.q, 2, ORDER_TOL);
    assert_near(o.v, 2, ORDER_TOL);
    assert_true(o.worst_gap < 5e-15);
    hn_model_close(&m);
}

static double worst_energy_error(hn_test_dae *d, double h, int n) {
    double worst = 0;
    for (int i = 0; i < n; i++) {
        assert_int_equal(hn_test_dae_steps(d, h, 1), HN_OK);
        hn_test_dae_measure(d);
        worst = fmax(worst, fabs(d->energy - BOB_ENERGY));
    }
    return worst;
}

static void energy_error_of_the_pendulum_is_the_known_one_and_stays(void **state) {
    (void)state;
    static const struct {
        double h, error; // known from an independent program
    } table[] = {{1e-2, 3.6e-3}, {1e-3, 3.6e-5}};
    for (int i = 0; i < 2; i++) {
        hn_model m;
        hn_test_dae d;
        hn_model_open_text(&m, bob, NULL);
        hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
        const int swing = (int)(3 / table[i].h); // longer than a period
        const double early = worst_energy_error(&d, table[i].h, swing);
        assert_rel(early, table[i].error, 0.02);
        assert_int_equal(hn_test_dae_steps(&d, table[i].h, 100000), HN_OK);
        assert_rel(worst_energy_error(&d, table[i].h, swing), early, 0.02);
        assert_true(d.gap < 1e-15);
        hn_test_dae_close(&d);
        hn_model_close(&m);
    }
}

static void going_there_and_back_returns_to_the_start(void **state) {
    (void)state;
    static const char *const names[] = {"fb0", "n-four-bar"};
    for (int i = 0; i < 2; i++) {
        hn_model m;
        hn_test_dae d;
        hn_model_open_closed(&m, names[i], NULL);
        hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
        assert_int_equal(hn_test_dae_steps(&d, 0.01, 50), HN_OK);
        assert_true(fabs(d.y[0] - m.q[0]) > 1e-2);
        d.table->accepted(d.self, 1);
        assert_int_equal(hn_test_dae_steps(&d, -0.01, 50), HN_OK);
        // the map is symmetric; what is left is rounding, amplified by the motion there and back
        assert_all_near(d.y, m.q, (size_t)m.info.nq, 1e-10);
        hn_test_dae_close(&d);
        hn_model_close(&m);
    }
}

static void a_step_does_not_allocate(void **state) {
    (void)state;
    hn_model m;
    hn_test_dae d;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
    const long before = hn_alloc_count();
    assert_int_equal(hn_test_dae_steps(&d, 1e-3, 10), HN_OK);
    assert_int_equal(hn_alloc_count(), before);
    hn_test_dae_close(&d);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_2_with_a_mass_that_turns_with_the_links),
        cmocka_unit_test(order_is_2_with_a_constant_mass),
        cmocka_unit_test(a_damper_is_refused_with_the_way_to_take_it),
        cmocka_unit_test(order_is_2_with_a_damper_split_off),
        cmocka_unit_test(energy_error_of_the_pendulum_is_the_known_one_and_stays),
        cmocka_unit_test(going_there_and_back_returns_to_the_start),
        cmocka_unit_test(a_step_does_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
