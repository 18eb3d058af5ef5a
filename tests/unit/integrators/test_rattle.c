// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"
#include "support/dae.h"
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/quaternion.h"
#include "integrators/list/stepper_list.h"
#include "linalg/dense.h"

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

static void check_order_2(const hn_model *m, const char *options) {
    hn_test_state exact;
    hn_test_reference(m, 1, &exact);
    const hn_test_orders o =
        hn_test_dae_orders(m, rattle(), HN_FORM_INDEX3, options, 1, 100, 4, &exact);
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

static void order_is_2_with_balls_and_with_redundant_rows(void **state) {
    (void)state;
    static const struct {
        const char *scene;
        double T;
        int steps; // of the coarsest: the top turns by 0.24 rad in each
    } table[] = {
        {"heavy-top", 0.4, 200}, {"rssr", 0.5, 100}, {"fb0-ball", 1, 100}, {"bennett", 0.5, 100}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        hn_model m;
        hn_test_state exact;
        hn_model_open_closed(&m, table[i].scene, NULL);
        hn_test_reference(&m, table[i].T, &exact);
        const hn_test_orders o = hn_test_dae_orders(&m, rattle(), HN_FORM_INDEX3, NULL, table[i].T,
                                                    table[i].steps, 4, &exact);
        assert_near(o.q, 2, ORDER_TOL);
        assert_near(o.v, 2, ORDER_TOL);
        assert_true(o.worst_gap < 5e-15);
        assert_true(o.worst_speed_gap < 1e-13); // speeds of 12 rad/s
        hn_model_close(&m);
    }
}

// where all turns are about one axis the group is a line: the same map as with an angle
static void a_ball_in_the_plane_moves_as_the_pin_does(void **state) {
    (void)state;
    hn_model pin, ball;
    hn_test_dae a, b;
    hn_model_open_closed(&pin, "fb0", NULL);
    hn_model_open_closed(&ball, "fb0-ball", NULL);
    hn_test_dae_open(&a, &pin, rattle(), HN_FORM_INDEX3, NULL);
    hn_test_dae_open(&b, &ball, rattle(), HN_FORM_INDEX3, NULL);
    assert_int_equal(hn_test_dae_steps(&a, 0.01, 200), HN_OK);
    assert_int_equal(hn_test_dae_steps(&b, 0.01, 200), HN_OK);
    double user_a[8], user_b[8];
    hn_system_to_user(pin.sys, a.y, user_a);
    hn_system_to_user(ball.sys, b.y, user_b);
    // rounding over 200 steps
    assert_near(user_b[hn_model_user(&ball, "th1")], user_a[hn_model_user(&pin, "th1")], 1e-12);
    assert_near(user_b[hn_model_user(&ball, "th3")], user_a[hn_model_user(&pin, "th3")], 1e-12);
    hn_test_dae_close(&a);
    hn_test_dae_close(&b);
    hn_model_close(&pin);
    hn_model_close(&ball);
}

static void turn_by(const double q[4], const double p[3], double out[3]) {
    const double back[4] = {q[0], -q[1], -q[2], -q[3]}, v[4] = {0, p[0], p[1], p[2]};
    double half[4], full[4];
    hn_quat_mul(q, v, half);
    hn_quat_mul(half, back, full);
    memcpy(out, full + 1, 3 * sizeof *out);
}

// q: 3 places and a quaternion; v: 3 speeds and the angular velocity in the block's axes
static void angular_momentum(const hn_test_dae *d, double out[3]) {
    const double a2 = 0.36, b2 = 0.09,
                 c2 = 0.01; // of the scene: m = 1 kg, a, b, c = 0.6, 0.3, 0.1 m
    const double *w = d->y + 7 + 3;
    const double p[3] = {(b2 + c2) / 12 * w[0], (a2 + c2) / 12 * w[1], (a2 + b2) / 12 * w[2]};
    turn_by(d->y + 3, p, out);
}

static void a_free_block_keeps_its_angular_momentum_to_rounding_while_it_tumbles(void **state) {
    (void)state;
    hn_model m;
    hn_test_dae d;
    double first[3], now[3], least = 5, worst = 0;
    hn_model_open_closed(&m, "spinning-block", NULL);
    assert_int_equal(m.info.nq, 7);
    hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
    angular_momentum(&d, first);
    assert_rel(hn_norm2(3, first), 5 * 0.37 / 12,
               1e-3); // and a hundredth of the spin about the others
    hn_test_dae_measure(&d);
    const double energy = d.energy;
    for (int i = 0; i < 2000; i++) {
        assert_int_equal(hn_test_dae_steps(&d, 0.01, 1), HN_OK);
        hn_test_dae_measure(&d);
        least = fmin(least, d.y[7 + 4]);
        worst = fmax(worst, fabs(d.energy / energy - 1));
    }
    angular_momentum(&d, now);
    assert_true(least < -4.9);             // it did turn over
    assert_all_near(now, first, 3, 1e-13); // R p0 = R p1 exactly: rounding over 2000 steps
    assert_true(worst < 1e-3);             // (h w)^2 / 12 is 2e-4
    hn_test_dae_close(&d);
    hn_model_close(&m);
}

static void a_step_of_more_than_half_a_turn_is_told(void **state) {
    (void)state;
    hn_model m;
    hn_test_dae d;
    hn_model_open_closed(&m, "spinning-block", NULL);
    hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
    assert_int_equal(hn_test_dae_steps(&d, 0.65, 1), HN_ERR_NO_CONVERGENCE); // 5 rad/s
    assert_non_null(strstr(d.table->why(d.self), "half a turn"));
    hn_test_dae_close(&d);
    hn_model_close(&m);
}

static void a_damper_is_refused_with_the_way_to_take_it(void **state) {
    (void)state;
    hn_model m;
    hn_diag diag = {0};
    void *self = NULL;
    const double options[HN_MAX_OPTIONS] = {1e-3, 0}, none[HN_MAX_OPTIONS] = {0};
    hn_arena *arena = hn_arena_create(0);
    hn_model_open_text(&m, damped_bob, NULL);
    assert_int_equal(
        rattle()->dae->create(m.sys, HN_FORM_INDEX3, options, none, arena, &self, &diag),
        HN_ERR_UNSUPPORTED);
    assert_non_null(strstr(diag.message, "velocit"));
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
    static const struct {
        const char *scene;
        double h, tol;
    } table[] = {{"fb0", 0.01, 1e-10},
                 {"n-four-bar", 0.01, 1e-10},
                 {"heavy-top", 1e-3, 1e-12},
                 {"rssr", 1e-3, 1e-12},
                 {"fb0-ball", 1e-3, 1e-12}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        hn_model m;
        hn_test_dae d;
        hn_model_open_closed(&m, table[i].scene, NULL);
        hn_test_dae_open(&d, &m, rattle(), HN_FORM_INDEX3, NULL);
        assert_int_equal(hn_test_dae_steps(&d, table[i].h, 50), HN_OK);
        assert_true(fabs(d.y[0] - m.q[0]) > 1e-2);
        d.table->on_accepted(d.self, 1);
        assert_int_equal(hn_test_dae_steps(&d, -table[i].h, 50), HN_OK);
        // the map is symmetric; what is left is rounding, amplified by the motion there and back
        assert_all_near(d.y, m.q, (size_t)m.info.nq, table[i].tol);
        assert_all_near(d.y + m.info.nq, m.v, (size_t)m.info.nv, 100 * table[i].tol);
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
        cmocka_unit_test(order_is_2_with_balls_and_with_redundant_rows),
        cmocka_unit_test(a_ball_in_the_plane_moves_as_the_pin_does),
        cmocka_unit_test(a_free_block_keeps_its_angular_momentum_to_rounding_while_it_tumbles),
        cmocka_unit_test(a_step_of_more_than_half_a_turn_is_told),
        cmocka_unit_test(a_damper_is_refused_with_the_way_to_take_it),
        cmocka_unit_test(order_is_2_with_a_damper_split_off),
        cmocka_unit_test(energy_error_of_the_pendulum_is_the_known_one_and_stays),
        cmocka_unit_test(going_there_and_back_returns_to_the_start),
        cmocka_unit_test(a_step_does_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
