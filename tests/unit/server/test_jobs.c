// SPDX-License-Identifier: GPL-3.0-or-later
// Whoever finds the queue full is told when it will have a place, not when all of it is done.
#include "http/ground/jobs.h"

#include "base/clock.h"
#include "support/near.h"

#include <stdatomic.h>
#include <time.h>

static const double LONGEST = 0.3; // [s]
static atomic_int ends;
static _Atomic double done; ///< the share that a job reports, 0: none

/// Works until it is told to end.
static void run(void *job, hn_job_turn *turn) {
    (void)job;
    hn_job_report(turn, atomic_load(&done));
    while (!atomic_load(&ends)) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
}

static void wait_until(double time) {
    while (hn_clock_wall() < time) {
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    }
}

static void a_place_is_free_when_the_first_job_ends(void **state) {
    enum { WAITING = 200 };
    (void)state;
    const hn_jobs_opts opts = {
        .at_once = 1, .n_waiting = WAITING, .n_waiting_of_one = WAITING, .longest = LONGEST};
    hn_jobs *jobs = hn_jobs_create(&opts, run);
    assert_non_null(jobs);
    atomic_store(&ends, 0);
    const double begun = hn_clock_wall();
    for (int i = 0; i <= WAITING; i++) {
        assert_true(hn_jobs_push(jobs, jobs, 1));
    }
    assert_false(hn_jobs_push(jobs, jobs, 1));

    // it has worked for as long as any job may, so that it ends soon; all 200 would take a minute
    wait_until(begun + 2 * LONGEST);
    assert_int_equal(hn_jobs_wait(jobs), 1);
    atomic_store(&ends, 1);
    hn_jobs_free(jobs);
}

static void who_is_refused_beside_a_long_job_waits_as_long_again(void **state) {
    (void)state;
    const hn_jobs_opts opts = {.at_once = 1, .n_waiting = 1, .n_waiting_of_one = 1, .longest = 1e6};
    hn_jobs *jobs = hn_jobs_create(&opts, run);
    assert_non_null(jobs);
    atomic_store(&ends, 0);
    const double begun = hn_clock_wall();
    assert_true(hn_jobs_push(jobs, jobs, 1));
    wait_until(begun + 1.2); // nothing else is known of it
    assert_true(hn_jobs_wait(jobs) >= 2);
    atomic_store(&ends, 1);
    hn_jobs_free(jobs);
}

static void a_job_that_reports_its_share_says_when_it_ends(void **state) {
    (void)state;
    const hn_jobs_opts opts = {.at_once = 1, .n_waiting = 1, .n_waiting_of_one = 1, .longest = 1e6};
    hn_jobs *jobs = hn_jobs_create(&opts, run);
    assert_non_null(jobs);
    atomic_store(&ends, 0);
    atomic_store(&done, 0.1);
    const double begun = hn_clock_wall();
    assert_true(hn_jobs_push(jobs, jobs, 1));

    // a tenth took at least half a second, so that the rest takes nine times as long; one that
    // reports nothing is said to go on for as long as it has worked
    wait_until(begun + 0.6);
    while (hn_jobs_wait(jobs) < 5 && hn_clock_wall() < begun + 4) {}
    assert_true(hn_jobs_wait(jobs) >= 5);
    atomic_store(&ends, 1);
    atomic_store(&done, 0);
    hn_jobs_free(jobs);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_place_is_free_when_the_first_job_ends),
        cmocka_unit_test(who_is_refused_beside_a_long_job_waits_as_long_again),
        cmocka_unit_test(a_job_that_reports_its_share_says_when_it_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
