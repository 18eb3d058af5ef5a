// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a double is that of printf with the fewest digits, from 15 on, that read back.
#include "base/shortest.h"
#include "support/near.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The definition, by trial; in the locale C.
static void by_trial(double value, char text[40]) {
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, 40, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            return;
        }
    }
}

static void check(double value) {
    for (int side = 0; side < 2; side++, value = -value) {
        char text[HN_SHORTEST_TEXT], expected[40];
        const int length = hn_shortest_write(value, text);
        assert_int_equal(length, (int)strlen(text));
        by_trial(value, expected);
        assert_string_equal(text, expected);
        assert_true(strtod(text, NULL) == value);
    }
}

/// A value and the doubles on either side of it, and a few further on.
static void check_around(double value) {
    double up = value, down = value;
    for (int k = 0; k < 6; k++) {
        check(up);
        check(down);
        up = nextafter(up, HUGE_VAL);
        down = nextafter(down, -HUGE_VAL);
    }
}

static uint64_t next(uint64_t *x) {
    *x = *x * 6364136223846793005ull + 1442695040888963407ull;
    return *x ^ (*x >> 29);
}

static void powers_of_ten_and_two_and_their_neighbours(void **state) {
    (void)state;
    for (int e = -330; e <= 308; e++) {
        check_around(pow(10, e));
        check_around(9.5 * pow(10, e));
    }
    for (int e = -1080; e <= 1023; e++) {
        check_around(ldexp(1, e));
        check_around(ldexp(1.5, e));
    }
    check(DBL_MAX);
    check(DBL_MIN);
    check(0);
}

static void numbers_of_few_digits(void **state) {
    (void)state;
    uint64_t seed = 7;
    for (int k = 0; k < 60000; k++) {
        char text[40];
        const int digits = 1 + (int)(next(&seed) % 17), exponent = (int)(next(&seed) % 34) - 17;
        snprintf(text, sizeof text, "%.*fe%d", digits - 1,
                 9 * (double)(next(&seed) >> 11) * 0x1p-53, exponent);
        check(strtod(text, NULL));
    }
    for (int k = 0; k < 20000; k++) { // steps of a run's clock, and sums of them
        check(k * 1e-3);
        check(k / 7.0);
        check(k + 0.5);
        check(ldexp(k, -20));
    }
}

static void numbers_of_all_sizes(void **state) {
    (void)state;
    uint64_t seed = 11;
    for (int k = 0; k < 60000; k++) { // every size a double has
        const uint64_t bits = next(&seed);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            check(value);
        }
    }
    for (int k = 0; k < 200000; k++) { // those of a mechanism
        const int exponent = (int)(next(&seed) % 90) - 45;
        check(ldexp(1 + (double)(next(&seed) >> 12) * 0x1p-52, exponent));
    }
}

// the Makefile makes a locale with a comma beside the programs
static void the_point_is_a_point_in_every_locale(void **state) {
    (void)state;
    char text[HN_SHORTEST_TEXT];
    setenv("LOCPATH", "build/locale", 1);
    assert_non_null(setlocale(LC_NUMERIC, "de_DE.UTF-8"));
    hn_shortest_write(1.25, text);
    assert_string_equal(text, "1.25");
    hn_shortest_write(1.25e-200, text); // by printf
    assert_string_equal(text, "1.25e-200");
    setlocale(LC_NUMERIC, "C");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(powers_of_ten_and_two_and_their_neighbours),
        cmocka_unit_test(numbers_of_few_digits),
        cmocka_unit_test(numbers_of_all_sizes),
        cmocka_unit_test(the_point_is_a_point_in_every_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
