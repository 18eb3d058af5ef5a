// SPDX-License-Identifier: GPL-3.0-or-later
// When loops of steps look at their limits: after each slow step, seldom between quick ones, and
// whatever the output asked for.

#include "base/clock.h"
#include "study/run/pace.h"
#include "study/run/walk.h"
#include "support/near.h"
#include "support/trial.h"

static void burn(double seconds) {
    const double end = hn_clock_thread() + seconds;
    while (hn_clock_thread() < end) {}
}

static void slow_steps_are_looked_at_one_by_one(void **state) {
    (void)state;
    hn_pace pace = hn_pace_begin();
    for (int i = 0; i < 10; i++) {
        burn(0.012);
        assert_int_equal(hn_pace_is_due(&pace), 1);
    }
}

static void quick_steps_are_seldom_interrupted(void **state) {
    (void)state;
    enum { STEPS = 1000000 };
    int looks = 0;
    hn_pace pace = hn_pace_begin();
    for (int i = 0; i < STEPS; i++) {
        looks += hn_pace_is_due(&pace);
    }
    // a hundredth at the least is spared even if the clock jumps now and then
    assert_in_range(looks, 1, STEPS / 100);
}

static void where_steps_become_slow_looks_become_frequent(void **state) {
    (void)state;
    hn_pace pace = {.last = hn_clock_thread(), .every = 400, .n = 399};
    burn(0.1);
    assert_int_equal(hn_pace_is_due(&pace), 1);
    assert_in_range(pace.every, 1, 40); // 400 steps took ten times as long as they may
}

static int stop_at_once(void *user) {
    ++*(int *)user;
    return 1;
}

static int go_on(void *user, int k, const hn_sample *sample) {
    (void)user;
    (void)k;
    (void)sample;
    return 1;
}

// each look is two steps after the one before
static void a_walk_is_stopped_however_often_it_is_looked_at(void **state) {
    (void)state;
    hn_trial trial;
    int asked = 0;
    const hn_walk_limits limits = {.stop = stop_at_once, .user = &asked};
    hn_trial_open(&trial, HN_TRIAL_LESSON "four-bar.json");
    hn_run *run = hn_trial_run(&trial, "index1@rk4:h=1e-3");
    assert_int_equal(hn_walk(run, 1, 500, &limits, go_on, NULL), HN_WALK_STOPPED);
    assert_int_equal(asked, 1);
    assert_true(hn_run_time(run) < 1);
    hn_run_free(run);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_steps_are_looked_at_one_by_one),
        cmocka_unit_test(quick_steps_are_seldom_interrupted),
        cmocka_unit_test(where_steps_become_slow_looks_become_frequent),
        cmocka_unit_test(a_walk_is_stopped_however_often_it_is_looked_at),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
