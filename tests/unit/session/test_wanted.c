// SPDX-License-Identifier: GPL-3.0-or-later
// An accuracy as people type it.
#include "support/near.h"

#include "session/precision/wanted.h"

static void lengths_are_shares_of_the_mechanism_and_angles_stay(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double error; // of a mechanism of 1.2 m
    } cases[] = {{"1 mm", 1e-3 / 1.2},
                 {"1mm ", 1e-3 / 1.2},
                 {"2,5 \xc2\xb5m", 2.5e-6 / 1.2},
                 {"3 um", 3e-6 / 1.2},
                 {"0.1 %", 1e-3},
                 {"1e-3", 1e-3},
                 {"1 mrad", 1e-3},
                 {"180 deg", 3.14159265358979312}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_wanted wanted = {.error = 999};
        assert_true(hn_wanted_read(cases[i].text, 1.2, &wanted));
        assert_near(wanted.error, cases[i].error, 1e-15); // two roundings
    }
    hn_wanted wanted;
    assert_true(hn_wanted_read("1 mm", 1.2, &wanted));
    assert_string_equal(wanted.words,
                        "an error of 1 mm at the end of a bar of 1.20 m (0.000833 of its length)");
}

static void what_is_no_error_is_refused(void **state) {
    (void)state;
    static const char *const cases[] = {"",        "mm",  "0",   "-1 mm", "1 kg",
                                        "1 mm mm", "nan", "inf", "1e999"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_wanted wanted;
        assert_false(hn_wanted_read(cases[i], 1.2, &wanted));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_shares_of_the_mechanism_and_angles_stay),
        cmocka_unit_test(what_is_no_error_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
