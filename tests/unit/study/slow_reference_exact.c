// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark problems whose motion is known in closed form, run by methods of different families.

#include "support/near.h"
#include "support/reference.h"

static void the_simple_pendulum_follows_the_elliptic_functions(void **state) {
    (void)state;
    hn_reference_check("a01-simple-pendulum");
}

static void one_four_bar_of_the_ladder_passes_its_flat_pose_for_ten_seconds(void **state) {
    (void)state;
    hn_reference_check("a02-n-four-bar-1");
}

static void two_four_bars_pass_theirs(void **state) {
    (void)state;
    hn_reference_check("a02-n-four-bar-2");
}

static void four_four_bars_pass_theirs(void **state) {
    (void)state;
    hn_reference_check("a02-n-four-bar-4");
}

static void the_driven_particle_turns_by_the_square_of_time(void **state) {
    (void)state;
    hn_reference_check("circle-particle");
}

static void a_coarse_run_does_not_agree(void **state) {
    (void)state;
    hn_reference *r = hn_reference_open("a01-simple-pendulum");
    hn_reference_state s = hn_reference_run_to(r, "a01-simple-pendulum", "index1@rk4:h=2e-2", 10);
    double digits = hn_reference_digits(r, HN_REFERENCE_Q, 10, &s);
    assert_true(digits > 2 && digits < 7); // h^4 t = 1.6e-6
    hn_reference_close(r);
}

static void digits_are_counted_from_the_largest_error(void **state) {
    (void)state;
    hn_reference *r = hn_reference_open("circle-particle");
    hn_reference_state s = hn_reference_trusted(r, 5);
    assert_near(hn_reference_digits(r, HN_REFERENCE_LAMBDA, 5, &s), 16, 0);
    s.x[HN_REFERENCE_LAMBDA][0] += 1e-6; // lambda is -100 there, its largest value
    assert_near(hn_reference_digits(r, HN_REFERENCE_LAMBDA, 5, &s), 8, 1e-6);
    hn_reference_close(r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_simple_pendulum_follows_the_elliptic_functions),
        cmocka_unit_test(one_four_bar_of_the_ladder_passes_its_flat_pose_for_ten_seconds),
        cmocka_unit_test(two_four_bars_pass_theirs),
        cmocka_unit_test(four_four_bars_pass_theirs),
        cmocka_unit_test(the_driven_particle_turns_by_the_square_of_time),
        cmocka_unit_test(a_coarse_run_does_not_agree),
        cmocka_unit_test(digits_are_counted_from_the_largest_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
