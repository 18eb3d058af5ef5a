// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "linalg/equilibrate.h"

static void a_negative_mass_is_refused_and_the_heaviest_found(void **state) {
    (void)state;
    const double M[9] = {2, 9, 9, 9, 5, 9, 9, 9, 0}, bad[4] = {3, 0, 0, -1e-300};
    double heaviest = 999;
    assert_int_equal(hn_heaviest_mass(2, bad, &heaviest), HN_ERR_NOT_SPD);
    assert_near(heaviest, 999, 0);
    assert_int_equal(hn_heaviest_mass(3, M, &heaviest), HN_OK);
    assert_near(heaviest, 5, 0);
    assert_true(hn_is_massless(0, heaviest));
    assert_true(hn_is_massless(4e-14, heaviest)); // below 1e-14 * 5
    assert_false(hn_is_massless(6e-14, heaviest));
}

static void a_column_is_as_large_as_its_largest_entry(void **state) {
    (void)state;
    const double J[6] = {1, -7, 0, 3, 2, 0};
    assert_near(hn_column_size(3, 2, J, 0), 3, 0);
    assert_near(hn_column_size(3, 2, J, 1), 7, 0);
    assert_near(hn_column_size(3, 2, J, 2), 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_negative_mass_is_refused_and_the_heaviest_found),
        cmocka_unit_test(a_column_is_as_large_as_its_largest_entry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
