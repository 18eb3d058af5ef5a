// SPDX-License-Identifier: GPL-3.0-or-later
// Full checks are made once in a way. What happens between two of them is told all the same.

#include "study/incidents/motion.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>

static int count(const hn_run *run, hn_incident_code code) {
    const hn_incident *incidents = NULL;
    int n = 0;
    for (int i = 0, all = hn_run_incidents(run, &incidents); i < all; i++) {
        n += incidents[i].code == code;
    }
    return n;
}

/// Steps until one was not checked in full: the run is between two full checks.
static const hn_watch *go_between(hn_run *run) {
    const hn_watch *w = hn_run_watching(run);
    long long checks;
    do {
        checks = w->checks;
        assert_int_equal(hn_run_step(run), HN_OK);
    } while (w->checks > checks);
    return w;
}

/// What the stride of the watch rests on: how far a motion goes says how much sigma_min has fallen.
static void between_full_checks_the_mechanism_is_far_from_singular_configurations(void **state) {
    (void)state;
    static const struct {
        const char *scene, *method;
        int steps;
    } cases[] = {{"fb0", "index1@rk4:h=1e-3", 3000},
                 {"n-four-bar", "projection@rk4:h=1e-4", 20000},
                 {"four-bar", "projection@rk4:h=1e-3", 5000},
                 {"five-bar", "projection@rk4:h=5e-4", 4000},
                 {"slider-crank", "projection@rk4:h=1e-3", 3000},
                 {"double-rocker", "projection@rk4:h=1e-3", 3000},
                 {"quick-return", "projection@rk4:h=1e-3", 3000},
                 {"stephenson-six-bar", "projection@rk4:h=2e-4", 5000},
                 {"watt-six-bar", "projection@rk4:h=5e-4", 3000},
                 {"seven-body-squeezer", "projection@rk4:h=2e-5", 1500},
                 {"rssr", "projection@rk4:h=1e-3", 3000},
                 {"delta-robot", "projection@rk4:h=5e-4", 1000},
                 {"spatial-slider-crank", "projection@dopri5:rtol=1e-12", 3000}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double step[64];
        long long seldom = 0;
        hn_model m;
        hn_model_open_closed(&m, cases[k].scene, NULL);
        assert_true(m.info.nv <= 64);
        hn_run *run = hn_motion_start(&m, cases[k].method);
        const hn_watch *w = hn_run_watching(run);
        const hn_stepping *s = hn_run_stepping(run);
        for (int i = 0; i < cases[k].steps; i++) {
            const long long checks = w->checks;
            if (hn_run_step(run) != HN_OK) {
                break;
            }
            if (w->checks > checks) {
                continue;
            }

            // the stride, or more where the motion speeds up; sigma_min loses half of what it may
            const double sigma =
                hn_singularity_probe(w->singular.monitor, s->now.t, s->now.q) / w->singular.largest;
            const double seen = w->singular.info.sigma_min / w->singular.largest;
            assert_true(w->stride >= 0.01 && w->stride <= 0.1);
            assert_true(hn_motion_way(w, w->checked_q, step) <= 2 * w->stride);
            assert_true(sigma > 0.5 * (seen + 0.4) - 0.03);
            seldom++;
        }
        assert_true(2 * seldom > w->checks);
        hn_run_free(run);
        hn_model_close(&m);
    }
}

/// |phi| at the state that the run has reached, by an evaluator of its own.
static double find_gap(const hn_model *m, const hn_run *run, const hn_stepping *s) {
    hn_eval *eval = NULL;
    double sum = 0;
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_PHI, m->arena, &eval), HN_OK);
    hn_eval_run(eval, hn_run_time(run), s->now.q, s->now.v);
    for (int i = 0; i < m->info.nc; i++) {
        sum = hypot(sum, hn_eval_get(eval, HN_TERM_PHI)[i]);
    }
    hn_eval_free(eval);
    return sum;
}

// a spike so small that the velocities explain the step well enough: no full check is made for it
static void a_gap_of_one_step_between_full_checks_is_told_and_is_the_worst(void **state) {
    (void)state;
    hn_run_opts opts = hn_run_opts_default();
    hn_diag diag = {0};
    hn_run *run = NULL;
    char why[256];
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    hn_run *first = hn_motion_start(&m, "projection@rk4:h=1e-4");
    opts.warn_gap = 1e-7;
    assert_int_equal(hn_run_create(m.sys, hn_run_spec(first), m.q, m.v, &opts, &run, &diag), HN_OK);

    assert_int_equal(hn_run_advance(run, 0.1), HN_OK);
    const hn_watch *w = go_between(run);
    hn_stepping *s = hn_run_stepping(run);
    const long long checks = w->checks;
    const double q = s->now.q[0];
    assert_int_equal(count(run, HN_INCIDENT_GAP_OPEN), 0);

    s->now.q[0] += 2e-6;
    const double gap = find_gap(&m, run, s);
    assert_true(gap > 1e-7 * hn_system_length(m.sys));
    assert_int_equal(hn_watch_check(hn_run_watching(run), why), HN_OK);
    s->now.q[0] = q;
    assert_true(w->checks == checks);
    assert_int_equal(count(run, HN_INCIDENT_GAP_OPEN), 1);
    assert_near(hn_run_get_summary(run).worst_gap, gap, 1e-15);

    // it stays the worst although the next steps are closed
    assert_int_equal(hn_run_advance(run, 0.2), HN_OK);
    assert_near(hn_run_get_summary(run).worst_gap, gap, 1e-15);
    hn_run_free(run);
    hn_run_free(first);
    hn_model_close(&m);
}

// the coupler and the rocker of the four-bar mirrored on the line from the crank's end to the
// ground: the loop stays closed, on its other branch
static void a_jump_to_the_other_branch_between_full_checks_is_told_at_once(void **state) {
    (void)state;
    char why[256];
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=1e-4");
    assert_int_equal(hn_run_advance(run, 0.2), HN_OK);
    const hn_watch *w = go_between(run);
    hn_stepping *s = hn_run_stepping(run);
    double *q = s->now.q;
    const long long checks = w->checks;

    const double diagonal = atan2(-sin(q[0]), 2.2 - cos(q[0]));
    q[1] = 2 * diagonal - q[1];
    q[2] = 2 * diagonal - q[2];
    assert_true(find_gap(&m, run, s) < 1e-6);
    assert_int_equal(hn_watch_check(hn_run_watching(run), why), HN_OK);
    assert_true(w->checks == checks + 1);
    assert_int_equal(count(run, HN_INCIDENT_BRANCH_FLIP), 1);
    hn_run_free(run);
    hn_model_close(&m);
}

static void where_the_velocities_turn_round_a_full_check_is_made(void **state) {
    (void)state;
    int turns = 0;
    hn_model m;
    hn_model_open_closed(&m, "triple-rocker", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    const hn_watch *w = hn_run_watching(run);
    const hn_stepping *s = hn_run_stepping(run);
    for (int i = 0; i < 6000; i++) {
        const long long checks = w->checks;
        double along = 0;
        assert_int_equal(hn_run_step(run), HN_OK);
        for (int k = 0; k < m.info.nv; k++) {
            along += s->now.v[k] * s->before.v[k];
        }
        if (along < 0) {
            assert_true(w->checks == checks + 1);
            turns++;
        }
    }
    assert_true(turns > 0);
    hn_run_free(run);
    hn_model_close(&m);
}

// beside a monitor that looks at every step
static void sigma_min_of_a_run_is_that_of_its_last_step(void **state) {
    (void)state;
    hn_singularity *every = NULL;
    hn_singularity_info info;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=1");
    assert_int_equal(hn_singularity_create(m.sys, m.arena, &every), HN_OK);
    hn_singularity_check(every, 0, m.q, m.v, &info);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-4");
    const hn_watch *w = hn_run_watching(run);
    const hn_stepping *s = hn_run_stepping(run);
    double apart = 0;
    for (int i = 0; i < 3000; i++) {
        assert_int_equal(hn_run_step(run), HN_OK);
        hn_singularity_check(every, s->now.t, s->now.q, s->now.v, &info);
        assert_rel(hn_run_sigma_min(run), info.sigma_min, 5e-3);
        assert_rel(hn_run_condition(run), info.sigma_max / info.sigma_min, 5e-3);
        apart = fmax(apart, fabs(w->singular.info.sigma_min / info.sigma_min - 1));
    }
    assert_true(apart > 0.01);
    hn_singularity_free(every);
    hn_run_free(run);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(between_full_checks_the_mechanism_is_far_from_singular_configurations),
        cmocka_unit_test(a_gap_of_one_step_between_full_checks_is_told_and_is_the_worst),
        cmocka_unit_test(a_jump_to_the_other_branch_between_full_checks_is_told_at_once),
        cmocka_unit_test(where_the_velocities_turn_round_a_full_check_is_made),
        cmocka_unit_test(sigma_min_of_a_run_is_that_of_its_last_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
