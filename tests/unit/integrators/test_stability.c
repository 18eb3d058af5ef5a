// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/near.h"
#include "support/odes.h"
#include "support/test_arena.h"

#include <math.h>
#include <string.h>

// The limits on the cards, tried: growth just beyond, decay or no growth just below.

// size of (x, x') of x'' + 2 a x' + b^2 x = 0 after n steps of length 1 from (1, 0), at most 1e100
static double size_after(const hn_stepper *s, double a, double b, int n) {
    hn_test_oscillator o = {a, b, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    double y[2] = {1, 0}, next[2], err[2], size = 1;
    void *self = s->create(1, 1, hn_test_arena);
    for (int i = 0; i < n && size < 1e100; i++) {
        assert_int_equal(s->step(self, &ode, 0, 1, y, next, err), HN_OK);
        s->on_accepted(self, 0);
        memcpy(y, next, sizeof y);
        size = hypot(y[0], y[1]);
    }
    return size;
}

static const struct {
    const char *name;
    double real_limit, imag_limit;
} table[] = {
    {"euler", 2.000, 0},      {"heun", 2.000, 0},       {"rk4", 2.785, 2.828},
    {"dopri5", 3.307, 0.997}, {"dop853", 6.394, 5.960}, {"symplectic-euler", 0.828, 2.0},
    {"verlet", 1.0, 2.0},
};
enum { N_TABLE = sizeof table / sizeof table[0] };

// the others choose their steps themselves, or take the differential-algebraic system
static int is_stepped_by_the_caller(const hn_stepper *s) {
    return s->create && s->step;
}

static int is_explicit(const hn_stepper *s) {
    return is_stepped_by_the_caller(s) && isfinite(s->real_limit);
}

static void cards_carry_the_limits_of_the_stability_polynomials(void **state) {
    (void)state;
    int served = 0;
    for (int k = 0; k < hn_stepper_count(); k++) {
        served += is_explicit(hn_stepper_at(k));
    }
    assert_int_equal(served, N_TABLE);
    for (int k = 0; k < N_TABLE; k++) {
        const hn_stepper *s = hn_stepper_find(table[k].name);
        assert_non_null(s);
        assert_near(s->real_limit, table[k].real_limit, 6e-4);
        assert_near(s->imag_limit, table[k].imag_limit, 6e-4);
    }
}

static void a_critically_damped_gap_decays_below_the_real_limit_and_grows_beyond(void **state) {
    (void)state;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_explicit(s)) {
            continue; // the others have tests of their own
        }
        const double below = 0.99 * s->real_limit, beyond = 1.01 * s->real_limit;
        assert_true(size_after(s, below, below, 5000) < 1e-3);
        assert_true(size_after(s, beyond, beyond, 5000) > 1e3);
    }
}

static void
an_undamped_oscillation_is_bounded_below_the_imaginary_limit_and_grows_beyond(void **state) {
    (void)state;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *s = hn_stepper_at(k);
        if (!is_explicit(s)) {
            continue; // the others have tests of their own
        }
        const int n = 1000000; // dopri5 grows by 1e-5 a step only just beyond its limit
        if (s->imag_limit == 0) {
            assert_true(size_after(s, 0, 0.2, n) > 1e3);
            continue;
        }
        assert_true(size_after(s, 0, 0.98 * s->imag_limit, n) < 20);
        assert_true(size_after(s, 0, 1.05 * s->imag_limit, n) > 1e3);
    }
}

// R(infinity) is 0 for Radau IIA, 1 or -1 for Gauss: what a stiff mode does, however large the step
static void methods_without_a_limit_damp_a_stiff_oscillation_or_let_it_ring(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int damps;
    } rows[] = {{"implicit-euler", 1}, {"radau3", 1}, {"radau5", 1},
                {"midpoint", 0},       {"gauss2", 0}, {"gauss3", 0}};
    int served = 0;
    for (int k = 0; k < hn_stepper_count(); k++) {
        served += is_stepped_by_the_caller(hn_stepper_at(k)) && !is_explicit(hn_stepper_at(k));
    }
    assert_int_equal(served, sizeof rows / sizeof rows[0]);
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
        const hn_stepper *s = hn_stepper_find(rows[k].name);
        const double b = 1e3, size = size_after(s, 0, b, 1000);
        if (rows[k].damps) {
            assert_true(size < 1e-10);
        } else { // x^2 + (x'/b)^2 stays 1: of (x, x') between 1 and b
            assert_in_range((long)(1e6 * size), 999999, (long)(1.001e6 * b));
        }
    }
}

static void explicit_euler_grows_by_the_exact_factor(void **state) {
    (void)state;
    const double w = 0.01;
    const int n = 20000;
    hn_test_oscillator o = {0, w, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    double y[2] = {1, 0};
    assert_int_equal(hn_test_integrate(hn_stepper_find("euler"), &ode, n, n, y, hn_test_arena),
                     HN_OK);
    // amplitude grows by sqrt(1 + h^2 w^2) a step
    assert_rel(hypot(y[0], y[1] / w), pow(1 + w * w, n / 2.0), 1e-10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cards_carry_the_limits_of_the_stability_polynomials),
        cmocka_unit_test_setup_teardown(
            a_critically_damped_gap_decays_below_the_real_limit_and_grows_beyond,
            hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(
            an_undamped_oscillation_is_bounded_below_the_imaginary_limit_and_grows_beyond,
            hn_test_arena_open, hn_test_arena_close),
        cmocka_unit_test_setup_teardown(
            methods_without_a_limit_damp_a_stiff_oscillation_or_let_it_ring, hn_test_arena_open,
            hn_test_arena_close),
        cmocka_unit_test_setup_teardown(explicit_euler_grows_by_the_exact_factor,
                                        hn_test_arena_open, hn_test_arena_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
