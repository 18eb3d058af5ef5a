// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the trials of the extreme matrix and compares results with predictions.
#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_model.h"
#include "session/extreme/extreme_store.h"
#include "session/extreme/extreme_verdict.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

int hn_extreme_is_stopped(void *user) {
    const hn_extreme_bench *bench = user;
    hn_job_progress(bench->limits, bench->id, bench->share);
    return hn_job_must_stop(bench->limits) ||
           (bench->deadline > 0 && hn_clock_wall() > bench->deadline);
}

/// Runs one trial; `whole` is its share of the matrix. Returns 0 when it was stopped: a trial that
/// is not complete has no result.
static bool run_trial(hn_extreme_bench *bench, hn_extreme_trial *t, double whole) {
    const int n = t->n_scenes * t->n_methods;
    for (int i = 0; i < n; i++) {
        const hn_extreme_scene *scene = t->scenes[i / t->n_methods];
        const char *method = t->methods[i % t->n_methods];
        t->seen[i] = (hn_extreme_seen){.scene = scene->name, .method = method};
        t->measure->see(bench, t, scene, method, &t->seen[i]);
        bench->share += whole / n;
        if (hn_extreme_is_stopped(bench)) {
            return false;
        }
    }
    hn_extreme_conclude(t);
    return true;
}

static hn_extreme_verdict case_verdict(const hn_extreme_case *c) {
    static const hn_extreme_verdict order[] = {HN_EXTREME_FAIL, HN_EXTREME_WARN, HN_EXTREME_PASS,
                                               HN_EXTREME_NOT_RUN, HN_EXTREME_LONG};
    for (int k = 0; k < HN_EXTREME_VERDICTS; k++) {
        for (int i = 0; i < c->n_trials; i++) {
            if (c->trials[i].verdict == order[k]) {
                return order[k];
            }
        }
    }
    return HN_EXTREME_NOT_RUN;
}

static int n_trials(const hn_extreme *x) {
    int n = 0;
    for (int i = 0; i < x->n_cases; i++) {
        n += x->cases[i].n_trials;
    }
    return n;
}

void hn_extreme_run(hn_extreme *x, const hn_job_limits *limits, bool run_long) {
    hn_extreme_bench bench = {.lib = x->lib, .limits = limits};
    const int all = n_trials(x);
    int done = 0;

    // the deadline of the whole matrix
    bench.deadline = limits->time_limit > 0 ? hn_clock_wall() + limits->time_limit : 0;
    for (int i = 0; i < x->n_cases; i++) {
        hn_extreme_case *c = &x->cases[i];
        for (int k = 0; k < c->n_trials; k++) {
            hn_extreme_trial *t = &c->trials[k];
            const int is_left_out = t->is_long && !run_long && t->n_seen == 0;
            done++;

            // leave out long trials not asked for, and trials done before
            if (is_left_out || t->n_seen > 0) {
                t->verdict = is_left_out ? HN_EXTREME_LONG : t->verdict;
                continue;
            }

            // run the trial and keep its result in the journal
            bench.id = c->id;
            bench.share = (done - 1.0) / all;
            if (!hn_extreme_is_stopped(&bench) && run_trial(&bench, t, 1.0 / all)) {
                hn_extreme_keep(x, i, k);
            }
        }
        c->verdict = case_verdict(c);
    }

    // note why the matrix ended, and close the journal accordingly
    x->stopped = hn_job_must_stop(limits);
    x->out_of_time = !x->stopped && hn_extreme_is_stopped(&bench);
    hn_journal_end(&x->journal, !x->stopped && !x->out_of_time);
    hn_extreme_bench_clear(&bench);
}

int hn_extreme_count(const hn_extreme *x, hn_extreme_verdict verdict) {
    int n = 0;
    for (int i = 0; i < x->n_cases; i++) {
        for (int k = 0; k < x->cases[i].n_trials; k++) {
            n += x->cases[i].trials[k].verdict == verdict;
        }
    }
    return n;
}
