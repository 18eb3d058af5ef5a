// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "support/model.h"
#include "support/near.h"
#include "support/odes.h"

#include "integrators/list/stepper_list.h"
#include "integrators/step/control.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void error_norm_is_the_rms_of_scaled_errors(void **state) {
    (void)state;
    const double err[2] = {3e-3, 4e-3}, y0[2] = {1, -2}, y1[2] = {0.5, 1};
    // scales 1e-3 + 1e-3 * {1, 2} = {2e-3, 3e-3}
    const hn_tolerance tol = {.rtol = 1e-3, .atol = 1e-3};
    assert_rel(hn_error_norm(2, err, y0, y1, &tol), sqrt((2.25 + 16.0 / 9) / 2), 1e-14);
    assert_near(hn_error_norm(0, err, y0, y1, &tol), 0, 0);
}

static void error_norm_of_a_state_that_is_not_finite_is_infinite(void **state) {
    (void)state;
    const double err[1] = {0}, y0[1] = {1}, bad[1] = {nan("")}, nan_err[1] = {nan("")};
    const hn_tolerance tol = {.rtol = 1e-3, .atol = 1e-3};
    assert_true(isinf(hn_error_norm(1, err, y0, bad, &tol)));
    assert_true(isinf(hn_error_norm(1, nan_err, y0, y0, &tol)));
}

static void a_unit_scales_the_absolute_tolerance_of_its_entry(void **state) {
    (void)state;
    const double err[2] = {3e-3, 4e3}, y0[2] = {1, 0}, y1[2] = {0.5, 0}, unit[2] = {1, 1e6};
    // scales 1e-3 + 1e-3, and 1e-3 * 1e6
    const hn_tolerance tol = {.rtol = 1e-3, .atol = 1e-3, .unit = unit};
    assert_rel(hn_error_norm(2, err, y0, y1, &tol), sqrt((2.25 + 16.0) / 2), 1e-14);
}

// continuous, the same after whole turns, |y| itself in the first half turn; speeds and lengths
// beside an angle keep |y|
static void the_size_of_an_angle_counts_from_the_nearest_whole_turn(void **state) {
    (void)state;
    static const bool is_angle[2] = {true, false};
    const hn_tolerance tol = {.rtol = 1e-6, .atol = 1e-6, .is_angle = is_angle, .n_pos = 2};
    const double turn = 2 * M_PI;
    for (double y = -M_PI; y < M_PI; y += 0.1) {
        assert_near(hn_tolerance_size(&tol, 0, y), fabs(y), 0);
        for (int k = -2000; k <= 2000; k += 500) {
            assert_near(hn_tolerance_size(&tol, 0, y + k * turn), fabs(y), 1e-11);
            assert_near(hn_tolerance_size(&tol, 1, y + k * turn), fabs(y + k * turn), 0);
            assert_near(hn_tolerance_size(&tol, 2, y + k * turn), fabs(y + k * turn), 0);
        }
    }
    assert_near(hn_tolerance_size(&tol, 0, M_PI * (1 + 1e-12)), M_PI, 1e-11);
    // an allowed error is not below the rounding of the angle
    const hn_tolerance tight = {.rtol = 1e-14, .atol = 1e-14, .is_angle = is_angle, .n_pos = 1};
    assert_true(hn_tolerance_of(&tight, 0, 1e5 * turn, 1e5 * turn) > 1e5 * turn * DBL_EPSILON);
}

// x of a slider-crank is a length, its angles are not
static void units_are_powers_of_ten_and_one_for_mechanisms_of_our_size(void **state) {
    (void)state;
    static const struct {
        const char *settings;
        double length, rate;
    } cases[] = {{NULL, 1, 1},
                 {"r=1e5 l=3e5 w1_0=0", 1e5, 1e-2},
                 {"r=1e-6 l=3e-6 w1_0=0", 1e-6, 1e3},
                 {"r=1e-6 l=3e-6 g=0 w1_0=0", 1e-6, 1},
                 {"w1_0=2e4", 1, 1e4}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        hn_model m;
        hn_model_open_closed(&m, "slider-crank", cases[k].settings);
        const hn_system_info info = hn_system_get_info(m.sys);
        double unit[16];
        assert_true(info.nq + info.nv <= 16);
        hn_tolerance_units(m.sys, false, m.v, unit);
        int lengths = 0;
        for (int i = 0; i < info.nv; i++) {
            const int c = hn_system_user_coordinate(m.sys, i);
            const bool is_length = hn_system_scene(m.sys)->coordinates[c].kind == HN_LENGTH;
            const double own = is_length ? cases[k].length : 1;
            lengths += is_length;
            assert_rel(unit[hn_system_position_of(m.sys, i)], own, 1e-12);
            assert_rel(unit[info.nq + i], own * cases[k].rate, 1e-12);
        }
        assert_true(lengths > 0);
        hn_model_close(&m);
    }
}

static void a_rejection_always_shrinks_and_the_next_step_does_not_grow(void **state) {
    (void)state;
    hn_step_control c = {.last = 1};
    assert_near(hn_step_factor(&c, 1e-12, 5), HN_STEP_GROW, 0);
    assert_true(hn_step_factor(&c, 1.0001, 5) <= HN_STEP_SAFETY);
    assert_true(hn_step_factor(&c, 1e-12, 5) <= 1);
    assert_near(hn_step_factor(&c, 1e-12, 5), HN_STEP_GROW, 0);
    assert_near(hn_step_factor(&c, 1e30, 5), HN_STEP_SHRINK, 0);
    assert_near(hn_step_factor(&c, HUGE_VAL, 5), HN_STEP_SHRINK, 0);
}

static void first_step_is_of_the_size_of_the_motion(void **state) {
    (void)state;
    for (double w = 1e-3; w < 1e4; w *= 10) {
        hn_test_oscillator o = {0, w, 0};
        const hn_ode ode = hn_test_oscillator_ode(&o);
        const double y[2] = {1, w};
        double f0[2], a[2], b[2], h = 0;
        assert_int_equal(hn_first_step(&ode, 0, y, 5, 1e-6, 1e-9, HUGE_VAL, f0, a, b, &h), HN_OK);
        assert_true(h * w > 1e-5 && h * w < 1.5);
    }
}

static void first_step_respects_the_largest_one(void **state) {
    (void)state;
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const double y[2] = {0, 0};
    double f0[2], a[2], b[2], h = 0;
    assert_int_equal(hn_first_step(&ode, 0, y, 5, 1e-6, 1e-9, 1e-9, f0, a, b, &h), HN_OK);
    assert_true(h > 0 && h <= 1e-9);
}

// the whole loop on an orbit: the error follows the tolerance
static double controlled_error(double rtol, int *steps) {
    const hn_stepper *s = hn_stepper_find("dopri5");
    const hn_ode ode = hn_test_kepler_ode();
    hn_arena *arena = hn_arena_create(0);
    hn_step_control c = {.last = 1};
    double y[4], next[4], err[4], exact[4], t = 0, h = 1e-3, worst = 0;
    const hn_tolerance tol = {.rtol = rtol, .atol = rtol};
    const double T = 6;
    void *self = s->create(2, 2, arena);
    hn_test_kepler_exact(0.5, 0, y);
    *steps = 0;
    while (t < T) {
        h = fmin(h, T - t);
        assert_int_equal(s->step(self, &ode, t, h, y, next, err), HN_OK);
        const double norm = hn_error_norm(4, err, y, next, &tol);
        if (norm <= 1) {
            s->on_accepted(self, 0);
            memcpy(y, next, sizeof y);
            t += h;
            ++*steps;
        }
        h *= hn_step_factor(&c, norm, 5);
    }
    hn_test_kepler_exact(0.5, T, exact);
    for (int i = 0; i < 4; i++) {
        worst = fmax(worst, fabs(y[i] - exact[i]));
    }
    hn_arena_free(arena);
    return worst;
}

static void error_of_a_controlled_run_follows_the_tolerance(void **state) {
    (void)state;
    double rtol[4], err[4], n[4];
    for (int i = 0; i < 4; i++) {
        int steps = 0;
        rtol[i] = pow(10, -5 - 1.5 * i);
        err[i] = controlled_error(rtol[i], &steps);
        n[i] = steps;
        assert_true(err[i] < 1e3 * rtol[i]);
    }
    assert_near(hn_test_slope(4, rtol, err), 1, 0.25);
    assert_near(hn_test_slope(4, rtol, n), -0.2, 0.05); // work of an order-5 method
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_norm_is_the_rms_of_scaled_errors),
        cmocka_unit_test(error_norm_of_a_state_that_is_not_finite_is_infinite),
        cmocka_unit_test(a_unit_scales_the_absolute_tolerance_of_its_entry),
        cmocka_unit_test(the_size_of_an_angle_counts_from_the_nearest_whole_turn),
        cmocka_unit_test(units_are_powers_of_ten_and_one_for_mechanisms_of_our_size),
        cmocka_unit_test(a_rejection_always_shrinks_and_the_next_step_does_not_grow),
        cmocka_unit_test(first_step_is_of_the_size_of_the_motion),
        cmocka_unit_test(first_step_respects_the_largest_one),
        cmocka_unit_test(error_of_a_controlled_run_follows_the_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
