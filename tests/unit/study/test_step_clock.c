// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of the steps: it counts the CPU time of what lies between start and stop, and neither
// what lies outside nor the time asleep.
#include "base/clock.h"
#include "study/run/step_clock.h"
#include "support/near.h"

#include <math.h>
#include <time.h>

enum { INTERVALS = 640, ROUNDS = 2000, BLOCK = 64, SPARSE = 7, TRIES = 400 };

static volatile double sink;

static void work(int rounds) {
    double x = 1;
    for (int i = 0; i < rounds; i++) {
        x = sqrt(x + i);
    }
    sink = x;
}

/// Fills blocks of a fresh clock, `own` rounds of work in each interval and three times as many
/// after it, until one was filled without the thread being put aside: its wall time is its CPU time
/// to a tenth. Returns the share of the CPU time that the clock counted, -1 where no try was
/// undisturbed; what holds on a disturbed machine too is asserted of every try.
static double share_of_block(hn_step_clock *c, int intervals, int own, double grain) {
    double share = -1;
    for (int i = 0; i < TRIES && share < 0; i++) {
        hn_step_clock_create(c);
        c->grain = grain >= 0 ? grain : c->grain;
        const double begin = hn_clock_thread(), wall = hn_clock_wall();
        for (int k = 0; k < intervals; k++) {
            hn_step_clock_start(c);
            work(own);
            hn_step_clock_stop(c);
            work(3 * own);
        }
        const double cpu = hn_clock_thread() - begin, passed = hn_clock_wall() - wall;
        const double read = hn_step_clock_read(c);
        assert_true(read >= 0 && read <= cpu);
        share = passed <= 1.1 * cpu ? read / cpu : -1;
    }
    return share;
}

static void a_quarter_of_the_work_is_a_quarter_of_the_time(void **state) {
    (void)state;
    hn_step_clock c;
    const double share = share_of_block(&c, BLOCK, ROUNDS, -1);
    // a processor that changes its pace within a block is why it is no closer
    assert_true(share < 0 || (share > 0.125 && share < 0.5));
}

// intervals of a few readings of the counter: it is read in one of SPARSE, and all are counted
static void short_intervals_are_counted_by_some_of_them(void **state) {
    (void)state;
    enum { SECOND = (BLOCK - 1) * SPARSE + 1 }; // intervals of a block whose last one is read
    hn_step_clock c;

    // the first block reads all intervals; a grain beyond all times makes them short on any machine
    hn_step_clock_create(&c);
    c.grain = 1e15;
    for (int i = 0; i < BLOCK + SECOND; i++) {
        assert_int_equal(c.n_read, i < BLOCK    ? i
                                   : i == BLOCK ? BLOCK
                                                : (i - BLOCK - 1) / SPARSE + 1);
        hn_step_clock_start(&c);
        hn_step_clock_stop(&c);
    }
    assert_true(c.every == SPARSE && c.n_read == BLOCK && c.n == 0);

    // a reading that takes as long as some hundred roots: less than a quarter by that
    const double share = share_of_block(&c, BLOCK + SECOND, ROUNDS / 4, 1000);
    assert_true(share < 0 || c.every != SPARSE || (share > 0.05 && share < 0.5));
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

// a program that is asked sleeps; what others compute until the next question is not its time
static void work_of_others_after_a_long_wait_is_nobodys(void **state) {
    (void)state;
    const struct timespec wait = {.tv_nsec = 300000};
    hn_step_clock c;
    double others = 0;
    hn_step_clock_create(&c);
    for (int i = 0; i < 3 * BLOCK / 2; i++) {
        hn_step_clock_start(&c);
        nanosleep(&wait, NULL);
        hn_step_clock_stop(&c);
        const double begin = hn_clock_thread();
        while (hn_clock_thread() - begin < 3e-4) {
            work(ROUNDS / 100);
        }
        others += hn_clock_thread() - begin;
    }
    assert_true(hn_step_clock_read(&c) < 0.5 * others);
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
        cmocka_unit_test(work_of_others_after_a_long_wait_is_nobodys),
        cmocka_unit_test(clear_forgets),
        cmocka_unit_test(reading_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
