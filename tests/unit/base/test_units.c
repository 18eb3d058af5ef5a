// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/units.h"

#include <math.h>

static void one_to_three_digits_stand_before_the_point(void **state) {
    (void)state;
    const struct {
        double value;
        const char *unit;
        int digits;
        const char *text;
    } cases[] = {
        {0.0042, "m", 2, "4.2 mm"},
        {1.3e-6, "s", 2, "1.3 \xc2\xb5s"},
        {-0.25, "m", 3, "-250 mm"},
        {1, "m", 3, "1.00 m"},
        {123456, "N", 3, "123 kN"},
        {999.96, "m", 3, "1.00 km"},
        {999.4, "m", 3, "999 m"},
        {9.9996e-4, "m", 3, "1.00 mm"},
        {0, "J", 3, "0 J"},
        {312, "kg", 3, "312 kg"},
        {0.02, "kg m^2", 2, "0.020 kg m^2"},
        {0.5, "", 2, "0.50"},
        {2.13e-17, "m", 2, "2.1e-17 m"},
        {5e16, "m", 1, "5e+16 m"},
        {4e-12, "m", 1, "4e-12 m"},
        {5.32e-10, "m", 3, "5.32e-10 m"},
        {1e-9, "m", 2, "1.0 nm"},
        {9.999e-10, "m", 2, "1.0 nm"},
        {4e-15, "m", 1, "4e-15 m"},
        {(double)NAN, "m", 3, "not finite"},
        {-(double)INFINITY, "m", 3, "not finite"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[HN_SI_TEXT];
        hn_si_format(cases[i].value, cases[i].unit, cases[i].digits, text);
        assert_string_equal(text, cases[i].text);
    }
}

static void round_numbers_are_one_two_or_five(void **state) {
    (void)state;
    assert_rel(hn_round_125(1), 1, 1e-15);
    assert_rel(hn_round_125(1.99), 1, 1e-15);
    assert_rel(hn_round_125(2), 2, 1e-15);
    assert_rel(hn_round_125(4.9), 2, 1e-15);
    assert_rel(hn_round_125(9.99), 5, 1e-15);
    assert_rel(hn_round_125(1000), 1000, 1e-15);
    assert_rel(hn_round_125(0.07), 0.05, 1e-15);
    assert_rel(hn_round_125(3e-9), 2e-9, 1e-15);
    for (int k = -12; k <= 12; k++) {
        assert_rel(hn_round_125(5 * pow(10, k)), 5 * pow(10, k), 1e-14);
        assert_rel(hn_round_125(pow(10, k)), pow(10, k), 1e-14);
    }
}

static void two_different_numbers_get_the_digits_that_tell_them_apart(void **state) {
    (void)state;
    assert_int_equal(hn_digits_apart(0.00121, 0.0012, 3), 3);
    assert_int_equal(hn_digits_apart(0.00120004, 0.0012, 3), 6);
    assert_int_equal(hn_digits_apart(nextafter(0.1, 1), 0.1, 3), 17);
    assert_int_equal(hn_digits_apart(5, 7, 1), 1);

    // equal numbers have no such digits
    assert_int_equal(hn_digits_apart(0.0012, 0.0012, 3), 3);
    assert_int_equal(hn_digits_apart((double)NAN, (double)NAN, 4), 4);
}

static void values_are_rounded_to_significant_digits(void **state) {
    (void)state;
    assert_true(hn_round_digits(0.253, 2) == 0.25);
    assert_true(hn_round_digits(-253, 2) == -250);
    assert_true(hn_round_digits(0.0996, 2) == 0.1);
    assert_true(hn_round_digits(0, 2) == 0);
    assert_true(isnan(hn_round_digits((double)NAN, 2)));
    assert_true(isinf(hn_round_digits(HUGE_VAL, 2)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_to_three_digits_stand_before_the_point),
        cmocka_unit_test(round_numbers_are_one_two_or_five),
        cmocka_unit_test(two_different_numbers_get_the_digits_that_tell_them_apart),
        cmocka_unit_test(values_are_rounded_to_significant_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
