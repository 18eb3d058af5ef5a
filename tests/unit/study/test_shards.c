// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/trial.h"

#include "study/cost/measure.h"
#include "study/cost/shards.h"

#include <math.h>
#include <string.h>

enum { METHODS = 3, LEVELS = 6, POINTS = METHODS * LEVELS };

typedef struct split {
    hn_trial trial;
    hn_ref *ref;
    hn_wp *wp;
} split;

static hn_wp *part_of(const split *s, int shard, int n, int samples) {
    static const char *const spellings[METHODS] = {"projection@rk4", "projection@dopri5",
                                                   "ggl@radau5"};
    const hn_wp_opts opts = {
        .n_levels = LEVELS, .n_samples = samples, .shard = shard, .n_shards = n};
    hn_method_spec specs[METHODS];
    hn_wp *wp = NULL;
    hn_diag diag = {0};
    for (int m = 0; m < METHODS; m++) {
        specs[m] = hn_trial_spec(spellings[m]);
    }
    if (hn_wp_create(s->trial.sys, s->trial.q, s->trial.v, s->ref, specs, METHODS, &opts, &wp,
                     &diag) != HN_OK) {
        fail_msg("%s", diag.message);
    }
    return wp;
}

static void open_split(split *s) {
    hn_diag diag = {0};
    hn_trial_open(&s->trial, HN_TRIAL_LESSON "fb0.json");
    assert_int_equal(hn_ref_create(s->trial.sys, s->trial.q, s->trial.v, 0.5, NULL, &s->ref, &diag),
                     HN_OK);
    s->wp = part_of(s, 0, 0, -1);
}

static void close_split(split *s) {
    hn_wp_free(s->wp);
    hn_ref_free(s->ref);
    hn_trial_close(&s->trial);
}

static void every_point_belongs_to_one_part_whatever_their_number(void **state) {
    (void)state;
    split s;
    int shard[POINTS], again[POINTS];
    open_split(&s);
    for (int n = 1; n <= POINTS + 5; n++) {
        int used[POINTS + 6] = {0};
        hn_wp_split(s.wp, n, shard);
        hn_wp_split(s.wp, n, again);
        assert_memory_equal(shard, again, sizeof shard);
        for (int i = 0; i < POINTS; i++) {
            assert_in_range(shard[i], 1, n);
            used[shard[i]] = 1;
        }
        for (int i = 1; i <= n && i <= POINTS; i++) {
            assert_true(used[i]); // nobody is idle while there is work
        }
    }
    close_split(&s);
}

/// Whoever gets the next point has least so far, so no more than the mean of the others' (Graham
/// 1966): the longest part ends within the mean load plus (1 - 1/n) of its last point.
static void the_longest_part_is_within_grahams_bound(void **state) {
    (void)state;
    split s;
    int shard[POINTS];
    open_split(&s);
    for (int n = 2; n <= 8; n++) {
        double sum[9] = {0}, all = 0, longest_point = 0, longest = 0;
        hn_wp_split(s.wp, n, shard);
        for (int i = 0; i < POINTS; i++) {
            const double c = hn_wp_expected_seconds(s.wp, i / LEVELS, i % LEVELS);
            assert_true(isfinite(c) && c > 0);
            sum[shard[i]] += c;
            all += c;
            longest_point = fmax(longest_point, c);
        }
        for (int i = 1; i <= n; i++) {
            longest = fmax(longest, sum[i]);
        }
        assert_true(longest <= all / n + longest_point * (1 - 1.0 / n) + 1e-15 * all);
    }
    close_split(&s);
}

static void finer_points_are_expected_to_cost_more(void **state) {
    (void)state;
    split s;
    open_split(&s);
    for (int m = 0; m < METHODS; m++) {
        for (int k = 1; k < LEVELS; k++) {
            assert_true(hn_wp_expected_seconds(s.wp, m, k) >
                        hn_wp_expected_seconds(s.wp, m, k - 1));
        }
    }
    // halving a fixed step doubles it exactly
    assert_near(hn_wp_expected_seconds(s.wp, 0, 5) / hn_wp_expected_seconds(s.wp, 0, 4), 2, 1e-14);
    close_split(&s);
}

static void a_part_runs_its_own_points_and_no_other(void **state) {
    (void)state;
    split s;
    open_split(&s);
    assert_true(hn_wp_run(s.wp, NULL));
    int done = 0;
    for (int i = 1; i <= 4; i++) {
        hn_wp *part = part_of(&s, i, 4, -1);
        assert_true(hn_wp_run(part, NULL));
        for (int m = 0; m < METHODS; m++) {
            for (int k = 0; k < LEVELS; k++) {
                const hn_wp_point *p = &part->methods[m].point[k], *r = &s.wp->methods[m].point[k];
                assert_int_equal(p->state == HN_WP_DONE, hn_wp_is_mine(part, m, k));
                if (p->state == HN_WP_DONE) {
                    assert_memory_equal(p->worst, r->worst, sizeof p->worst);
                    assert_memory_equal(p->end_q, r->end_q, (size_t)s.ref->n_user * sizeof(double));
                    assert_true(p->cost.ops == r->cost.ops);
                    done++;
                }
            }
        }
        hn_wp_free(part);
    }
    assert_int_equal(done, POINTS);
    close_split(&s);
}

static void the_yardstick_is_the_same_run_in_every_part(void **state) {
    (void)state;
    split s;
    open_split(&s);
    for (int i = 1; i <= 2; i++) {
        hn_wp *part = part_of(&s, POINTS * i / 2, POINTS, 1);
        assert_true(hn_wp_run(part, NULL));
        assert_int_equal(part->yardstick_method, 0);
        assert_int_equal(part->yardstick.n_samples, 1);
        assert_true(part->yardstick.median > 0);
        hn_wp_free(part);
    }
    close_split(&s);
}

static void parts_that_cannot_be_are_refused(void **state) {
    (void)state;
    split s;
    open_split(&s);
    static const int wrong[][2] = {{1, -1}, {0, 2}, {3, 2}, {-1, 2}, {1, HN_WP_SHARDS + 1}, {1, 0}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const hn_wp_opts opts = {.shard = wrong[i][0], .n_shards = wrong[i][1]};
        const hn_method_spec spec = hn_trial_spec("projection@rk4");
        hn_diag diag = {0};
        hn_wp *wp = NULL;
        assert_int_equal(
            hn_wp_create(s.trial.sys, s.trial.q, s.trial.v, s.ref, &spec, 1, &opts, &wp, &diag),
            HN_ERR_INPUT);
        assert_string_equal(diag.pointer, "/shard");
        assert_null(wp);
    }
    close_split(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_belongs_to_one_part_whatever_their_number),
        cmocka_unit_test(the_longest_part_is_within_grahams_bound),
        cmocka_unit_test(finer_points_are_expected_to_cost_more),
        cmocka_unit_test(a_part_runs_its_own_points_and_no_other),
        cmocka_unit_test(the_yardstick_is_the_same_run_in_every_part),
        cmocka_unit_test(parts_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
