// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/near.h"
#include "support/odes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Ten million small steps: the integrator's own error is far below rounding, so what is seen is
// what summing does.

enum { STEPS = 10000000 };
#define T 10.0

// x'' = -x from (1, 0) over ten million steps: largest error at the end
static double error_after(const hn_stepper *s, double sum, hn_arena *arena) {
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const double h = T / STEPS, options[2] = {h, sum};
    double y[2] = {1, 0}, next[2];
    void *self = s->create(1, 1, arena);
    assert_non_null(self);
    s->configure(self, options);
    for (long i = 0; i < STEPS; i++) {
        assert_true(s->step(self, &ode, (double)i * h, h, y, next, NULL) == HN_OK);
        s->on_accepted(self, 0);
        memcpy(y, next, sizeof y);
    }
    return fmax(fabs(y[0] - cos(T)), fabs(y[1] + sin(T)));
}

static void rounding_of_ten_million_steps_falls_to_that_of_one(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    const hn_stepper *s = hn_stepper_find("rk4");
    const double plain = error_after(s, 0, arena), compensated = error_after(s, 1, arena);
    print_message("rk4, %d steps: error %.2g plain, %.2g compensated\n", STEPS, plain, compensated);
    // each plain sum is cut by up to 1.1e-16: at random 3000 of those, one-sidedly up to 1e7 of
    // them
    assert_true(plain > 3e-14);
    // the slopes are evaluated at a state rounded to 1.1e-16, for ten seconds, which the motion
    // neither damps nor amplifies
    assert_true(compensated < 3e-15);
    hn_arena_free(arena);
}

static void a_method_of_order_two_is_left_with_its_own_error(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    const hn_stepper *s = hn_stepper_find("verlet");
    const double h = T / STEPS, compensated = error_after(s, 1, arena);
    // the phase is ahead by T h^2/24 and the speed's amplitude short by h^2/8; rounding may add a
    // hundredth
    const double own = fabs(T * h * h / 24 * cos(T) - h * h / 8 * sin(T));
    print_message("verlet: error %.3g, its own %.3g\n", compensated, own);
    assert_rel(compensated, own, 0.01);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounding_of_ten_million_steps_falls_to_that_of_one),
        cmocka_unit_test(a_method_of_order_two_is_left_with_its_own_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
