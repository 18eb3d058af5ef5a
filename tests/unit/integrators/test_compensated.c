// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/odes.h"

#include "integrators/list/stepper_list.h"
#include "integrators/step/compensated.h"

#include <math.h>
#include <string.h>

static const char *const names[] = {"euler", "heun", "rk4", "symplectic-euler", "verlet"};
enum { N_NAMES = sizeof names / sizeof *names };

static void a_hundred_thousand_tenths_make_ten_thousand(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_compensated c;
    double y = 0, plain = 0, next;
    const double tenth = 0.1;
    assert_true(hn_compensated_init(&c, 1, arena));
    hn_compensated_switch(&c, 1);
    for (int i = 0; i < 100000; i++) {
        hn_compensated_add(&c, 0, 1, &y, &tenth, &next);
        hn_compensated_accepted(&c, 0);
        y = next;
        plain += tenth;
    }
    assert_true(fabs(plain - 1e4) > 1e-8);
    assert_near(y, 1e4,
                1e-12); // 0.1 itself is 5.6e-18 off, a hundred thousand times; and a last rounding
    hn_arena_free(arena);
}

static void what_is_cut_off_is_exact_whichever_is_larger(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_compensated c;
    const double big = 1e16, small[1] = {1.25}, y[1] = {1.25};
    double next;
    assert_true(hn_compensated_init(&c, 1, arena));
    hn_compensated_switch(&c, 1);
    hn_compensated_add(&c, 0, 1, &big, small, &next);
    assert_near(next - big, 2, 0); // neighbours of 1e16 are 2 apart
    assert_near(c.trial[0], -0.75, 0);
    hn_compensated_add(&c, 0, 1, y, &big, &next);
    assert_near(c.trial[0], -0.75, 0);
    hn_arena_free(arena);
}

static void a_changed_state_starts_without_a_carry(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    hn_compensated c;
    const double y = 1, tiny = 1e-17;
    double next;
    assert_true(hn_compensated_init(&c, 1, arena));
    hn_compensated_switch(&c, 1);
    hn_compensated_add(&c, 0, 1, &y, &tiny, &next);
    hn_compensated_accepted(&c, 0);
    assert_near(c.kept[0], 1e-17, 0);
    hn_compensated_accepted(&c, 1);
    assert_near(c.kept[0], 0, 0);
    hn_arena_free(arena);
}

// ten steps of x'' = -x with the sum as told
static void ten_steps(const hn_stepper *s, double sum, hn_arena *arena, double y[2]) {
    hn_test_oscillator o = {0, 1, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    const double options[2] = {0.01, sum};
    double next[2];
    void *self = s->create(1, 1, arena);
    s->configure(self, options);
    y[0] = 1;
    y[1] = 0.5;
    for (int i = 0; i < 10; i++) {
        assert_int_equal(s->step(self, &ode, i * 0.01, 0.01, y, next, NULL), HN_OK);
        s->on_accepted(self, 0);
        memcpy(y, next, sizeof next);
    }
}

static void it_is_the_same_method_but_for_rounding(void **state) {
    (void)state;
    hn_arena *arena = hn_arena_create(0);
    for (int i = 0; i < N_NAMES; i++) {
        const hn_stepper *s = hn_stepper_find(names[i]);
        double plain[2], compensated[2];
        assert_string_equal(s->options[HN_FIXED_STEP_SUM].key, "sum");
        ten_steps(s, 0, arena, plain);
        ten_steps(s, 1, arena, compensated);
        assert_all_near(compensated, plain, 2, 3e-15); // ten roundings
    }
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hundred_thousand_tenths_make_ten_thousand),
        cmocka_unit_test(what_is_cut_off_is_exact_whichever_is_larger),
        cmocka_unit_test(a_changed_state_starts_without_a_carry),
        cmocka_unit_test(it_is_the_same_method_but_for_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
