// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/run_time.h"
#include "support/near.h"

#include <math.h>

static void times_are_above_zero_and_at_most_the_bound(void **state) {
    (void)state;
    const struct {
        double time;
        bool zero, good;
    } cases[] = {{1e-9, false, true},
                 {1e6, false, true},
                 {0, true, true},
                 {0, false, false},
                 {-1, true, false},
                 {1000000.4, true, false},
                 {(double)NAN, true, false},
                 {(double)INFINITY, false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_diags diags = {0};
        assert_int_equal(hn_run_time_check(cases[i].time, cases[i].zero, "time", "/time", &diags),
                         cases[i].good ? HN_OK : HN_ERR_INPUT);
        assert_int_equal(diags.n, !cases[i].good);
    }
}

static void a_time_just_above_the_bound_is_written_so_that_it_differs_from_it(void **state) {
    (void)state;
    hn_diags diags = {0};
    assert_int_equal(hn_run_time_check(1000000.4, true, "duration", "/duration", &diags),
                     HN_ERR_INPUT);
    assert_string_equal(diags.item[0].message,
                        "the duration is 1000000.4 s; 0 to 1e6 s are allowed");
    assert_string_equal(diags.item[0].pointer, "/duration");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(times_are_above_zero_and_at_most_the_bound),
        cmocka_unit_test(a_time_just_above_the_bound_is_written_so_that_it_differs_from_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
