// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of the steps: it counts the CPU time of what lies between start and stop, and neither
// what lies outside nor the time asleep.
#include "base/clock.h"
#include "study/run/step_clock.h"
#include "support/near.h"

#include <math.h>
#include <time.h>

enum { INTERVALS = 640, ROUNDS = 2000 };

static volatile double sink;

static void work(int rounds) {
    double x = 1;
    for (int i = 0; i < rounds; i++) {
        x = sqrt(x + i);
    }
    sink = x;
}

static void a_quarter_of_the_work_is_a_quarter_of_the_time(void **state) {
    (void)state;
    hn_step_clock c;
    hn_step_clock_create(&c);
    const double begin = hn_clock_thread();
    for (int i = 0; i < INTERVALS; i++) {
        hn_step_clock_start(&c);
        work(ROUNDS);
        hn_step_clock_stop(&c);
        work(3 * ROUNDS);
    }
    const double share = hn_step_clock_read(&c) / (hn_clock_thread() - begin);

    // a thread that is put aside blurs the wall clock of a block, not its CPU time: the share stays
    // far from all and from nothing
    assert_in_range((int)(1000 * share), 125, 500);
}

// intervals of a few readings of the counter: it is read in some of them, and all are counted
static void short_intervals_are_counted_by_some_of_them(void **state) {
    (void)state;
    hn_step_clock c;
    hn_step_clock_create(&c);
    c.grain = 1000; // a reading that takes as long as some hundred roots: every machine is quick
    const double begin = hn_clock_thread();
    for (int i = 0; i < 20 * INTERVALS; i++) {
        hn_step_clock_start(&c);
        work(ROUNDS / 4);
        hn_step_clock_stop(&c);
        work(3 * ROUNDS / 4);
    }
    const double share = hn_step_clock_read(&c) / (hn_clock_thread() - begin);
    assert_true(c.every > 1 && c.n_read < c.n);
    assert_in_range((int)(1000 * share), 100, 500); // less than a quarter by the grain
}

static void long_intervals_are_all_read(void **state) {
    (void)state;
    hn_step_clock c;
    hn_step_clock_create(&c);
    c.grain = 0;
    for (int i = 0; i < INTERVALS; i++) {
        hn_step_clock_start(&c);
        work(ROUNDS);
        hn_step_clock_stop(&c);
        assert_int_equal(c.every, 1);
    }
}

static void time_asleep_is_nobodys(void **state) {
    (void)state;
    const struct timespec nap = {.tv_nsec = 2000000};
    hn_step_clock c;
    hn_step_clock_create(&c);
    const double begin = hn_clock_thread();
    for (int i = 0; i < 50; i++) {
        hn_step_clock_start(&c);
        work(ROUNDS);
        hn_step_clock_stop(&c);
        nanosleep(&nap, NULL);
    }
    const double read = hn_step_clock_read(&c);
    assert_true(read > 0);
    assert_true(read <= hn_clock_thread() - begin);
}

static void clear_forgets(void **state) {
    (void)state;
    hn_step_clock c;
    hn_step_clock_create(&c);
    hn_step_clock_start(&c);
    work(ROUNDS);
    hn_step_clock_stop(&c);
    assert_true(hn_step_clock_read(&c) > 0);
    hn_step_clock_clear(&c);
    assert_true(hn_step_clock_read(&c) == 0);
}

// what is written of a run between its steps is the same twice
static void reading_changes_nothing(void **state) {
    (void)state;
    hn_step_clock c;
    hn_step_clock_create(&c);
    hn_step_clock_start(&c);
    work(ROUNDS);
    hn_step_clock_stop(&c);
    work(3 * ROUNDS); // the CPU clock of the thread is past what the step took
    const double first = hn_step_clock_read(&c);
    work(ROUNDS);
    assert_true(first > 0 && hn_step_clock_read(&c) == first);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quarter_of_the_work_is_a_quarter_of_the_time),
        cmocka_unit_test(short_intervals_are_counted_by_some_of_them),
        cmocka_unit_test(long_intervals_are_all_read),
        cmocka_unit_test(time_asleep_is_nobodys),
        cmocka_unit_test(clear_forgets),
        cmocka_unit_test(reading_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
