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

/// Both at one moment: again where the thread was put aside between the readings.
static void read_both(double *wall, double *ticks) {
    double after;
    do {
        *wall = hn_clock_wall();
        *ticks = hn_clock_ticks();
        after = hn_clock_wall();
    } while (after - *wall > 1e-3);
}

static void the_counter_runs_on_as_evenly_as_the_wall_clock(void **state) {
    (void)state;
    double wall[3], ticks[3];
    for (int i = 0; i < 3; i++) {
        read_both(&wall[i], &ticks[i]);
        usleep(50000);
    }
    const double first = (ticks[1] - ticks[0]) / (wall[1] - wall[0]);
    const double second = (ticks[2] - ticks[1]) / (wall[2] - wall[1]);
    assert_true(first > 0);
    assert_rel(second, first, 0.1); // each is known to a millisecond or two in fifty
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleep_takes_wall_time_and_no_time_of_the_processor),
        cmocka_unit_test(work_takes_time_of_the_processor),
        cmocka_unit_test(the_counter_runs_on_as_evenly_as_the_wall_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
