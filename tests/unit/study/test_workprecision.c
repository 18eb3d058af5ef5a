// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/measure.h"

#include "base/clock.h"
#include "support/alloc.h"
#include "support/near.h"
#include "support/trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static hn_wp *study_of(const hn_trial *trial, const hn_ref *ref, const char *const *spellings,
                       int n, const hn_wp_opts *opts) {
    hn_method_spec specs[4];
    hn_wp *wp = NULL;
    hn_diag diag = {0};
    for (int i = 0; i < n; i++) {
        specs[i] = hn_trial_spec(spellings[i]);
    }
    if (hn_wp_create(trial->sys, trial->q, trial->v, ref, specs, n, opts, &wp, &diag) != HN_OK) {
        fail_msg("%s", diag.message);
    }
    return wp;
}

static hn_ref *reference_of(const hn_trial *trial, double T) {
    hn_ref *ref = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_ref_create(trial->sys, trial->q, trial->v, T, NULL, &ref, &diag), HN_OK);
    return ref;
}

static void counts_are_the_same_the_second_time(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[2] = {"projection@rk4", "projection@dopri5"};
    const hn_wp_opts opts = {.n_samples = -1, .n_levels = 4};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    hn_wp *a = study_of(&trial, ref, spellings, 2, &opts);
    hn_wp *b = study_of(&trial, ref, spellings, 2, &opts);
    assert_true(hn_wp_run(a, NULL));
    assert_true(hn_wp_run(b, NULL));
    for (int m = 0; m < 2; m++) {
        for (int k = 0; k < 4; k++) {
            const hn_wp_point *p = &a->methods[m].point[k], *r = &b->methods[m].point[k];
            assert_int_equal(p->state, HN_WP_DONE);
            assert_int_equal(p->cost.evals, r->cost.evals);
            assert_true(p->cost.ops == r->cost.ops && p->cost.ops > 0);
            assert_int_equal(p->steps, r->steps);
            assert_memory_equal(p->worst, r->worst, sizeof p->worst);
        }
    }
    // halving the step doubles what a fixed step costs, exactly
    assert_int_equal(a->methods[0].point[1].steps, 2 * a->methods[0].point[0].steps);
    hn_wp_free(a);
    hn_wp_free(b);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void a_method_that_cannot_serve_the_scene_stays_with_its_reason(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[2] = {"partitioning@rk4", "projection@rk4"};
    const hn_wp_opts opts = {.n_samples = -1, .n_levels = 2};
    hn_trial_open(&trial, "lessons/09-space-and-drives/scenes/heavy-top.json");
    hn_ref *ref = reference_of(&trial, 0.05);
    hn_wp *wp = study_of(&trial, ref, spellings, 2, &opts);
    assert_true(hn_wp_run(wp, NULL));
    assert_int_equal(wp->methods[0].point[0].state, HN_WP_FAILED);
    assert_int_equal(wp->methods[0].point[0].status, HN_ERR_UNSUPPORTED);
    assert_true(wp->methods[0].point[0].reason[0] != 0);
    assert_int_equal(wp->methods[1].point[1].state, HN_WP_DONE);
    hn_wp_free(wp);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void a_budget_that_is_too_small_leaves_points_out_and_says_so(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[1] = {"projection@rk4"};
    const hn_wp_opts opts = {.n_levels = 4, .time_limit = 1e-6};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    hn_wp *wp = study_of(&trial, ref, spellings, 1, &opts);
    assert_false(hn_wp_run(wp, NULL));
    assert_true(wp->out_of_time);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(wp->methods[0].point[k].state, HN_WP_SKIPPED);
        assert_non_null(strstr(wp->methods[0].point[k].reason, "time limit"));
    }
    hn_wp_free(wp);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

/// The findings of a study must not depend on how much of its time limit was left.
static void errors_are_taken_at_all_times_or_the_point_is_left_out(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[1] = {"projection@rk4"};
    hn_wp_opts opts = {.n_levels = 3, .n_samples = -1};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 10);

    // how long the states between those of the reference take here
    hn_wp *wp = study_of(&trial, ref, spellings, 1, &opts);
    const hn_walk_limits none = {0};
    const double started = hn_clock_thread();
    assert_int_equal(
        hn_refined_create(trial.sys, ref, wp->errors, 1e10, &none, wp->arena, &wp->refined), HN_OK);
    const double seconds = hn_clock_thread() - started;
    assert_false(wp->refined->too_long);
    hn_wp_free(wp);

    // limits around it: the points that are done have all times
    for (double share = 0.25; share < 20; share *= 2) {
        opts.time_limit = share * seconds;
        wp = study_of(&trial, ref, spellings, 1, &opts);
        const bool finished = hn_wp_run(wp, NULL);
        for (int again = 0; again < 2; again++) {
            for (int k = 0; k < 3; k++) {
                const hn_wp_point *p = &wp->methods[0].point[k];
                assert_true(p->state == HN_WP_DONE || (!finished && p->state == HN_WP_SKIPPED));
                assert_true(p->state != HN_WP_DONE || p->times == ref->n * HN_REFINED_PARTS);
                assert_true(p->state == HN_WP_DONE || strstr(p->reason, "time limit"));
            }
            wp->opts.time_limit = 0;
            assert_true(hn_wp_run(wp, NULL));
        }
        assert_int_equal(wp->methods[0].point[0].state, HN_WP_DONE);
        hn_wp_free(wp);
    }
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

/// The operations end it, at the same place on every machine.
static void states_that_take_too_long_are_told(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[1] = {"projection@rk4"};
    const hn_wp_opts opts = {.n_levels = 2, .n_samples = -1};
    const hn_walk_limits none = {0};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 10);
    int found[2];
    for (int i = 0; i < 2; i++) {
        hn_wp *wp = study_of(&trial, ref, spellings, 1, &opts);
        assert_int_equal(
            hn_refined_create(trial.sys, ref, wp->errors, 1e6, &none, wp->arena, &wp->refined),
            HN_OK);
        assert_true(wp->refined->too_long);
        found[i] = wp->refined->found;
        assert_true(found[i] > 0 && found[i] < ref->n);
        assert_true(hn_wp_run(wp, NULL));
        const hn_wp_point *p = &wp->methods[0].point[1];
        assert_true(p->too_long);
        assert_int_equal(p->times, ref->n + found[i] * (HN_REFINED_PARTS - 1));
        hn_wp_free(wp);
    }
    assert_int_equal(found[0], found[1]);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void memory_that_runs_out_before_the_first_point_is_told(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[1] = {"projection@rk4"};
    const hn_wp_opts opts = {.n_levels = 2, .n_samples = -1};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    for (int n = 1; n <= 4; n++) {
        hn_wp *wp = study_of(&trial, ref, spellings, 1, &opts);
        hn_alloc_fail_at(n);
        assert_false(hn_wp_run(wp, NULL));
        assert_true(hn_alloc_has_failed());
        hn_alloc_fail_at(0);
        assert_int_equal(wp->status, HN_ERR_MEMORY);
        assert_false(wp->stopped || wp->out_of_time);
        assert_int_equal(wp->methods[0].point[0].state, HN_WP_PENDING);
        hn_wp_free(wp);
    }
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void count_point(void *user, int m, int k) {
    (void)m;
    (void)k;
    ++*(int *)user;
}

static int stop_after_one(void *user) {
    return *(int *)user > 0;
}

static void a_stopped_study_keeps_what_it_has_and_goes_on_from_there(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[2] = {"projection@rk4", "projection@dopri5"};
    const hn_wp_opts opts = {.n_levels = 3, .n_samples = -1};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    hn_wp *whole = study_of(&trial, ref, spellings, 2, &opts);
    hn_wp *broken = study_of(&trial, ref, spellings, 2, &opts);
    assert_true(hn_wp_run(whole, NULL));
    int points = 0, done = 0;
    const hn_wp_hooks hooks = {.user = &points, .stop = stop_after_one, .point = count_point};
    assert_false(hn_wp_run(broken, &hooks));
    for (int i = 0; i < 6; i++) {
        done += broken->methods[i / 3].point[i % 3].state == HN_WP_DONE;
    }
    assert_true(broken->stopped && done > 0 && done < 6);
    assert_true(hn_wp_run(broken, NULL));
    for (int i = 0; i < 6; i++) {
        const hn_wp_point *p = &whole->methods[i / 3].point[i % 3];
        const hn_wp_point *r = &broken->methods[i / 3].point[i % 3];
        assert_memory_equal(p->worst, r->worst, sizeof p->worst);
        assert_memory_equal(&p->own, &r->own, sizeof p->own);
        assert_int_equal(p->cost.evals, r->cost.evals);
    }
    hn_wp_free(whole);
    hn_wp_free(broken);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

static void samples_of_time_are_batches_above_the_clocks_grain(void **state) {
    (void)state;
    hn_trial trial;
    static const char *const spellings[1] = {"projection@rk4"};
    const hn_wp_opts opts = {.n_levels = 2, .n_samples = 3};
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    hn_ref *ref = reference_of(&trial, 0.5);
    hn_wp *wp = study_of(&trial, ref, spellings, 1, &opts);
    assert_true(hn_wp_run(wp, NULL));
    for (int k = 0; k < 2; k++) {
        const hn_wp_point *p = &wp->methods[0].point[k];
        assert_int_equal(p->n_samples, 3);
        assert_true(p->median > 0 && p->low <= p->median && p->median <= p->high);
    }
    // sizes are the ladder's: the one of the spelling is gone
    char spelling[HN_SPEC_MAX];
    hn_wp_spelling(wp, 0, 1, spelling);
    assert_string_equal(wp->methods[0].spelling, "projection@rk4");
    assert_near(hn_method_option(&wp->methods[0].spec, "h", 0), 1e-3, 0);
    assert_near(wp->methods[0].point[1].size, wp->methods[0].point[0].size / 2, 0);
    const hn_method_spec again = hn_trial_spec(spelling);
    assert_near(hn_method_option(&again, "h", 0), wp->methods[0].point[1].size, 0);
    hn_wp_free(wp);
    hn_ref_free(ref);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_the_same_the_second_time),
        cmocka_unit_test(a_method_that_cannot_serve_the_scene_stays_with_its_reason),
        cmocka_unit_test(a_budget_that_is_too_small_leaves_points_out_and_says_so),
        cmocka_unit_test(errors_are_taken_at_all_times_or_the_point_is_left_out),
        cmocka_unit_test(states_that_take_too_long_are_told),
        cmocka_unit_test(memory_that_runs_out_before_the_first_point_is_told),
        cmocka_unit_test(a_stopped_study_keeps_what_it_has_and_goes_on_from_there),
        cmocka_unit_test(samples_of_time_are_batches_above_the_clocks_grain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
