// SPDX-License-Identifier: GPL-3.0-or-later
// Whoever finds the queue full is told when it has a place for him, not when all of it is done.
#include "http/ground/jobs.h"

#include "base/clock.h"
#include "http/ground/promises.h"
#include "support/near.h"

#include <stdatomic.h>
#include <time.h>

static const double LONGEST = 0.3; // [s]
static atomic_int ends;
static _Atomic double done; ///< the share that a job reports, 0: none
static _Atomic double used; ///< computing time of the job [s]

/// Computes until it is told to end.
static void run(void *job, hn_job_turn *turn) {
    (void)job;
    const double begun = hn_clock_thread();
    hn_job_report(turn, atomic_load(&done) > 0 ? 1e-3 : 0);
    while (!atomic_load(&ends)) {
        hn_job_report(turn, atomic_load(&done));
        atomic_store(&used, hn_clock_thread() - begun);
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
    atomic_store(&used, 0);
    for (int i = 0; i <= WAITING; i++) {
        assert_true(hn_jobs_push(jobs, jobs, 1, 0));
    }
    assert_false(hn_jobs_push(jobs, jobs, 1, 0));

    // it has worked for as long as any job may, so that it ends soon; all 200 would take a minute
    while (atomic_load(&used) < LONGEST) {}
    assert_int_equal(hn_jobs_wait(jobs, 1, 1), 1);
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
    assert_true(hn_jobs_push(jobs, jobs, 1, 0));
    wait_until(begun + 1.2); // nothing else is known of it
    assert_true(hn_jobs_wait(jobs, 1, 1) >= 2);
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
    assert_true(hn_jobs_push(jobs, jobs, 1, 0));

    // a tenth took at least half a second, so that the rest takes nine times as long; one that
    // reports nothing is said to go on for as long as it has worked
    wait_until(begun + 0.6);
    while (hn_jobs_wait(jobs, 1, 1) < 5 && hn_clock_wall() < begun + 4) {}
    assert_true(hn_jobs_wait(jobs, 1, 1) >= 5);

    // the first place is for one of those who were refused, the next for another, as much later
    const int first = hn_jobs_wait(jobs, 1, 1), second = hn_jobs_wait(jobs, 1, 2);
    assert_in_range(second, first + 5, 3 * first);
    assert_in_range(hn_jobs_wait(jobs, 1, 3), second + 5, 3 * second);
    assert_in_range(hn_jobs_wait(jobs, 1, 1), first, second); // whoever asks again keeps his turn
    atomic_store(&ends, 1);
    atomic_store(&done, 0);
    hn_jobs_free(jobs);
}

static void a_job_that_should_have_reported_may_take_the_longest(void **state) {
    enum { SECONDS = 20 };
    (void)state;
    const hn_jobs_opts opts = {.at_once = 1,
                               .n_waiting = 2,
                               .n_waiting_of_one = 1,
                               .n_aside = 1,
                               .n_aside_of_one = 1,
                               .longest = SECONDS,
                               .reports = true};
    hn_jobs *jobs = hn_jobs_create(&opts, run);
    assert_non_null(jobs);
    atomic_store(&ends, 0);
    assert_true(hn_jobs_push(jobs, jobs, 1, 0));
    assert_true(hn_jobs_push(jobs, jobs, 1, 0));

    // when the first job makes way, the one that waits leaves its place; the next one at an end
    assert_int_equal(hn_jobs_wait(jobs, 1, 1), 1);
    assert_true(hn_jobs_wait(jobs, 1, 2) >= SECONDS);
    atomic_store(&ends, 1);
    hn_jobs_free(jobs);
}

static void promises_are_for_one_client_and_end(void **state) {
    (void)state;
    hn_promises p = {0};
    const hn_client one = 1, two = 2;
    hn_promises_make(&p, one, 11, 10);
    hn_promises_make(&p, two, 12, 20);
    hn_promises_make(&p, one, 13, 30);
    assert_int_equal(hn_promises_ahead(&p, NULL, 14, 0), 3);
    assert_int_equal(hn_promises_ahead(&p, &one, 14, 0), 2);
    assert_int_equal(hn_promises_ahead(&p, NULL, 12, 0), 1); // only those before its own

    hn_promises_end(&p, 13);
    hn_promises_end(&p, 99);
    assert_int_equal(hn_promises_ahead(&p, NULL, 14, 0), 2);
    assert_int_equal(hn_promises_ahead(&p, NULL, 14, 15), 1);
    for (uint64_t i = 0; i < 2 * HN_PROMISES; i++) {
        hn_promises_make(&p, one, 0, 40);
    }
    assert_int_equal(hn_promises_ahead(&p, NULL, 14, 15), HN_PROMISES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_place_is_free_when_the_first_job_ends),
        cmocka_unit_test(who_is_refused_beside_a_long_job_waits_as_long_again),
        cmocka_unit_test(a_job_that_reports_its_share_says_when_it_ends),
        cmocka_unit_test(a_job_that_should_have_reported_may_take_the_longest),
        cmocka_unit_test(promises_are_for_one_client_and_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
