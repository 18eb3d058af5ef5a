// SPDX-License-Identifier: GPL-3.0-or-later
// Trials run, and what is seen compared with what is predicted.
#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_model.h"
#include "session/extreme/extreme_store.h"

#include "base/clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *hn_extreme_verdict_name(hn_extreme_verdict verdict) {
    static const char *const names[] = {
#define HN_VERDICT_NAME(code, name) name,
        HN_VERDICT_LIST(HN_VERDICT_NAME)
#undef HN_VERDICT_NAME
    };
    return names[verdict];
}

int hn_extreme_is_stopped(void *user) {
    const hn_extreme_bench *bench = user;
    hn_job_progress(bench->limits, bench->id, bench->share);
    return hn_job_must_stop(bench->limits) ||
           (bench->deadline > 0 && hn_clock_wall() > bench->deadline);
}

// verdicts ----

static hn_extreme_verdict judge_number(const hn_extreme_expect *e, double value) {
    if (isnan(value)) {
        return HN_EXTREME_FAIL;
    }
    if (value >= e->low && value <= e->high) {
        return HN_EXTREME_PASS;
    }
    return value >= e->warn_low && value <= e->warn_high ? HN_EXTREME_WARN : HN_EXTREME_FAIL;
}

/// The worst of all numbers; of words all, some, or none are as expected.
static hn_extreme_verdict judge(const hn_extreme_trial *t) {
    hn_extreme_verdict worst = HN_EXTREME_PASS;
    double share = 0;
    for (int i = 0; i < t->n_seen; i++) {
        const double value = t->seen[i].value;
        if (t->expect.word) {
            share += isnan(value) ? 0 : value / t->n_seen;
            continue;
        }
        const hn_extreme_verdict one = judge_number(&t->expect, value);
        worst = one > worst ? one : worst;
    }
    if (!t->expect.word) {
        return worst;
    }
    return share > 1 - 1e-9 ? HN_EXTREME_PASS : share > 0 ? HN_EXTREME_WARN : HN_EXTREME_FAIL;
}

static void tell_words(hn_extreme_trial *t) {
    const hn_extreme_seen *first = &t->seen[0];
    int good = 0;
    for (int i = 0; i < t->n_seen; i++) {
        good += t->seen[i].value > 1 - 1e-9;
        if (first->value > 1 - 1e-9) {
            first = &t->seen[i]; // the first that is not as expected
        }
    }
    if (good == t->n_seen) {
        snprintf(t->observed, sizeof t->observed, "%s%s%.120s", t->seen[0].word,
                 t->seen[0].reason[0] && t->n_seen == 1 ? ": " : "",
                 t->n_seen == 1 ? t->seen[0].reason : "");
    } else {
        snprintf(t->observed, sizeof t->observed, "%d of %d; %s %s%s%.80s", good, t->n_seen,
                 first->method, first->word, first->reason[0] ? ": " : "", first->reason);
    }
}

static void tell_numbers(hn_extreme_trial *t) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < t->n_seen; i++) {
        if (isnan(t->seen[i].value)) {
            snprintf(t->observed, sizeof t->observed, "%.140s", t->seen[i].reason);
            return;
        }
        low = fmin(low, t->seen[i].value);
        high = fmax(high, t->seen[i].value);
    }
    if (low == high) {
        snprintf(t->observed, sizeof t->observed, "%.6g", low);
    } else {
        snprintf(t->observed, sizeof t->observed, "%.5g to %.5g", low, high);
    }
}

// runs ----

void hn_extreme_conclude(hn_extreme_trial *t) {
    t->n_seen = t->n_scenes * t->n_methods;
    t->verdict = judge(t);
    if (t->expect.word) {
        tell_words(t);
    } else {
        tell_numbers(t);
    }
}

/// `whole`: its share of the matrix. 0 when it was stopped: half a trial says nothing.
static int run_trial(hn_extreme_bench *bench, hn_extreme_trial *t, double whole) {
    const int n = t->n_scenes * t->n_methods;
    for (int i = 0; i < n; i++) {
        const hn_extreme_scene *scene = t->scenes[i / t->n_methods];
        const char *method = t->methods[i % t->n_methods];
        t->seen[i] = (hn_extreme_seen){.scene = scene->name, .method = method};
        t->measure->see(bench, t, scene, method, &t->seen[i]);
        bench->share += whole / n;
        if (hn_extreme_is_stopped(bench)) {
            return 0;
        }
    }
    hn_extreme_conclude(t);
    return 1;
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
    bench.deadline = limits->time_limit > 0 ? hn_clock_wall() + limits->time_limit : 0;
    for (int i = 0; i < x->n_cases; i++) {
        hn_extreme_case *c = &x->cases[i];
        for (int k = 0; k < c->n_trials; k++) {
            hn_extreme_trial *t = &c->trials[k];
            const int is_left_out = t->is_long && !run_long && t->n_seen == 0;
            done++;
            if (is_left_out || t->n_seen > 0) { // done before: what is left is told by the others
                t->verdict = is_left_out ? HN_EXTREME_LONG : t->verdict;
                continue;
            }
            bench.id = c->id;
            bench.share = (done - 1.0) / all;
            if (!hn_extreme_is_stopped(&bench) && run_trial(&bench, t, 1.0 / all)) {
                hn_extreme_keep(x, i, k);
            }
        }
        c->verdict = case_verdict(c);
    }
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
