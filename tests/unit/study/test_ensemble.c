// SPDX-License-Identifier: GPL-3.0-or-later
// Runs side by side beside the same runs one by one: the same bits, ends and counts.
#include "study/ensemble/ensemble.h"
#include "support/near.h"
#include "support/trial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MEMBERS = 200, MAX_N = 16 };
static const double END = 0.4; // [s]

static double next(uint64_t *x) {
    *x = *x * 6364136223846793005ull + 1442695040888963407ull;
    return (double)(*x >> 11) * 0x1p-52 - 1;
}

/// Random starts, steps and feedbacks; what came of them side by side.
typedef struct members {
    double q[MEMBERS][MAX_N], v[MEMBERS][MAX_N];
    hn_ensemble_start start[MEMBERS];
    double q_end[MEMBERS * MAX_N], v_end[MEMBERS * MAX_N];
    hn_ensemble_end end[MEMBERS];
} members;

/// Most near the scene's own start; every ninth so fast that it comes to grief.
static void fill(const hn_trial *trial, double h, bool baumgarte, members *m) {
    uint64_t x = 11;
    for (int k = 0; k < MEMBERS; k++) {
        for (int i = 0; i < trial->info.nq; i++) {
            m->q[k][i] = trial->q[i] + 1e-3 * next(&x);
        }
        for (int i = 0; i < trial->info.nv; i++) {
            m->v[k][i] = trial->v[i] + (k % 9 == 0 ? 1e4 : 1) * next(&x);
        }
        m->start[k] = (hn_ensemble_start){.q = m->q[k],
                                          .v = m->v[k],
                                          .h = h * (1 + 0.5 * next(&x)),
                                          .alpha = baumgarte ? 5 + 4 * next(&x) : 0,
                                          .beta = baumgarte ? 8 + 4 * next(&x) : 0};
    }
}

static void compare_member(const hn_trial *trial, const char *method, const members *m, int k) {
    char text[HN_SPEC_MAX];
    hn_method_spec spec = hn_trial_spec(method);
    hn_run *run;
    hn_diag diag;
    *hn_method_find_option(&spec, "h", NULL) = m->start[k].h;
    if (hn_method_find_option(&spec, "alpha", NULL)) {
        *hn_method_find_option(&spec, "alpha", NULL) = m->start[k].alpha;
        *hn_method_find_option(&spec, "beta", NULL) = m->start[k].beta;
    }
    if (hn_run_create(trial->sys, &spec, m->q[k], m->v[k], NULL, &run, &diag) != HN_OK) {
        fail_msg("%s", diag.message);
    }
    hn_run_watch(run, 0);
    const hn_status status = hn_run_advance(run, END);
    const hn_run_summary s = hn_run_get_summary(run);
    const hn_stepping *at = hn_run_stepping(run);

    hn_method_format(&spec, text);
    if (status != m->end[k].status || s.steps != m->end[k].steps || s.t != m->end[k].t) {
        print_message("%s: %s after %lld steps at %.17g; alone %s after %lld at %.17g\n", text,
                      hn_status_text(m->end[k].status), m->end[k].steps, m->end[k].t,
                      hn_status_text(status), s.steps, s.t);
        fail();
    }
    assert_memory_equal(at->now.q, m->q_end + k * trial->info.nq,
                        (size_t)trial->info.nq * sizeof(double));
    assert_memory_equal(at->now.v, m->v_end + k * trial->info.nv,
                        (size_t)trial->info.nv * sizeof(double));
    hn_run_free(run);
}

static void run_members(const hn_trial *trial, const char *method, hn_lanes_set set, int threads,
                        int n, members *m) {
    const hn_method_spec spec = hn_trial_spec(method);
    hn_ensemble_opts opts = hn_ensemble_opts_default();
    hn_ensemble *e;
    hn_diag diag = {0};
    opts.set = set;
    opts.threads = threads;
    if (hn_ensemble_create(trial->sys, &spec, &opts, &e, &diag) != HN_OK) {
        fail_msg("%s: %s", trial->scene->name, diag.message);
    }
    memset(m->q_end, 0xff, sizeof m->q_end);
    memset(m->v_end, 0xff, sizeof m->v_end);
    hn_ensemble_run(e, n, m->start, END, m->q_end, m->v_end, m->end);
    hn_ensemble_free(e);
}

static void check(const char *scene, const char *method, double h) {
    static members m, others;
    hn_trial trial;
    hn_trial_open(&trial, scene);
    assert_true(trial.info.nq <= MAX_N && trial.info.nv <= MAX_N);
    fill(&trial, h, strstr(method, "baumgarte") != NULL, &m);
    run_members(&trial, method, hn_lanes_set_best(), 2, MEMBERS, &m);
    long long alone = 0, steps = 0;
    for (int k = 0; k < MEMBERS; k++) {
        compare_member(&trial, method, &m, k);
        alone += m.end[k].in_doubt;
        steps += m.end[k].steps;
    }
    assert_true(10 * alone < steps); // lanes did the work

    // any instruction set, number of threads and company gives the same
    memcpy(others.start, m.start, sizeof m.start);
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        const int n = set == 0 ? 5 : MEMBERS;
        run_members(&trial, method, (hn_lanes_set)set, 1 + set % 2, n, &others);
        assert_memory_equal(others.q_end, m.q_end, (size_t)(n * trial.info.nq) * sizeof(double));
        assert_memory_equal(others.v_end, m.v_end, (size_t)(n * trial.info.nv) * sizeof(double));
        assert_memory_equal(others.end, m.end, (size_t)n * sizeof *m.end);
    }
    hn_trial_close(&trial);
}

#define CABINET "lessons/11-cabinet/scenes/"
#define SPACE "lessons/09-space-and-drives/scenes/"

static void runs_side_by_side_have_the_bits_of_runs_alone(void **state) {
    (void)state;
    check(HN_TRIAL_LESSON "fb0.json", "index1@rk4:h=1e-3", 1e-3);
    check(HN_TRIAL_LESSON "fb0.json", "baumgarte:alpha=5,beta=5@rk4:h=1e-3", 1e-3);
    check(HN_TRIAL_LESSON "four-bar.json", "baumgarte:alpha=5,beta=5@heun:h=1e-3", 2e-3);
    check(HN_TRIAL_LESSON "double-pendulum.json", "index1@euler:h=1e-3", 1e-3);
    check(HN_TRIAL_LESSON "slider-crank.json", "index1@rk4:h=1e-3", 1e-3);
    check(CABINET "watt-six-bar.json", "baumgarte:alpha=5,beta=5@rk4:h=1e-3", 1e-3);
    check(SPACE "oblique-four-bar.json", "index1@rk4:h=1e-3", 1e-3);
    check(SPACE "seven-body-squeezer.json", "index1@rk4:h=1e-5", 2e-3);
}

/// The parallelogram passes its flat pose, where lanes come into doubt.
static void lanes_in_doubt_step_alone(void **state) {
    (void)state;
    static members m;
    hn_trial trial;
    hn_trial_open(&trial, CABINET "parallelogram.json");
    fill(&trial, 2e-3, false, &m);
    run_members(&trial, "index1@rk4:h=1e-3", hn_lanes_set_best(), 1, MEMBERS, &m);
    long long alone = 0;
    for (int k = 0; k < MEMBERS; k++) {
        compare_member(&trial, "index1@rk4:h=1e-3", &m, k);
        alone += m.end[k].in_doubt;
    }
    assert_true(alone > 0);
    hn_trial_close(&trial);
}

static void starts_that_cannot_be_are_told(void **state) {
    (void)state;
    static members m;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0.json");
    fill(&trial, 1e-3, false, &m);
    m.q[1][0] = (double)NAN;
    m.start[2].h = 0;
    m.start[3].h = 1e-12;
    run_members(&trial, "index1@rk4:h=1e-3", HN_LANES_PLAIN, 1, 5, &m);
    const hn_status wanted[5] = {m.end[0].status, HN_ERR_INPUT, HN_ERR_INPUT, HN_ERR_STOPPED,
                                 HN_OK};
    for (int k = 1; k < 5; k++) {
        assert_int_equal(m.end[k].status, wanted[k]);
        assert_true(k == 4 ? m.end[k].t >= END : m.end[k].steps == 0);
    }
    hn_trial_close(&trial);
}

static void methods_that_keep_something_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *scene, *method, *why;
    } rows[] = {
        {HN_TRIAL_LESSON "fb0.json", "projection@rk4:h=1e-3", "from one step to the next"},
        {HN_TRIAL_LESSON "fb0.json", "baumgarte:rule=auto@rk4:h=1e-3", "from one step to the next"},
        {HN_TRIAL_LESSON "fb0.json", "index1@dopri5:rtol=1e-6", "not an explicit one"},
        {HN_TRIAL_LESSON "fb0.json", "index1@rk4:h=1e-3,sum=compensated", "plain sum"},
        {HN_TRIAL_LESSON "fb0.json", "index1:solver=dense@rk4:h=1e-3",
         "not compiled to instructions"},
        {SPACE "heavy-top.json", "index1@rk4:h=1e-3", "quaternions"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_trial trial;
        hn_diag diag = {0};
        hn_ensemble *e;
        const hn_method_spec spec = hn_trial_spec(rows[i].method);
        const hn_ensemble_opts opts = hn_ensemble_opts_default();
        hn_trial_open(&trial, rows[i].scene);
        assert_int_equal(hn_ensemble_create(trial.sys, &spec, &opts, &e, &diag),
                         HN_ERR_UNSUPPORTED);
        assert_non_null(strstr(diag.message, rows[i].why));
        hn_trial_close(&trial);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_side_by_side_have_the_bits_of_runs_alone),
        cmocka_unit_test(lanes_in_doubt_step_alone),
        cmocka_unit_test(starts_that_cannot_be_are_told),
        cmocka_unit_test(methods_that_keep_something_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
