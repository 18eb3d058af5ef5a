// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/clock.h"

#include <unistd.h>

static void sleep_takes_wall_time_and_no_time_of_the_processor(void **state) {
    (void)state;
    const double wall = hn_clock_wall(), cpu = hn_clock_thread();
    usleep(20000);
    assert_true(hn_clock_wall() - wall >= 0.02);
    assert_true(hn_clock_thread() - cpu < 0.02);
}

static void work_takes_time_of_the_processor(void **state) {
    (void)state;
    const double wall = hn_clock_wall(), cpu = hn_clock_thread();
    while (hn_clock_thread() - cpu < 0.005) {}
    // grains of the two clocks may differ by some microseconds
    assert_true(hn_clock_wall() - wall > 0.0049);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleep_takes_wall_time_and_no_time_of_the_processor),
        cmocka_unit_test(work_takes_time_of_the_processor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
