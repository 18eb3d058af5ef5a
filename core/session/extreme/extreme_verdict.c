// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- outcomes of a run ----

static const struct {
    hn_status status;
    const char *word;
} OUTCOMES[] = {
    {HN_OK, "finished"},
    {HN_ERR_INPUT, "refused"},
    {HN_ERR_LIMIT, "refused"},
    {HN_ERR_UNSUPPORTED, "refused"},
    {HN_ERR_UNREACHABLE, "unreachable"},
    {HN_ERR_INCONSISTENT, "inconsistent"},
    {HN_ERR_SINGULAR, "singular"},
    {HN_ERR_NOT_SPD, "singular"},
    {HN_ERR_MASS, "singular"},
    {HN_ERR_NO_CONVERGENCE, "no-convergence"},
    {HN_ERR_CHART, "chart-lost"},
    {HN_ERR_DIVERGED, "diverged"},
    {HN_ERR_STEP_UNDERFLOW, "step-underflow"},
    {HN_ERR_STOPPED, "out-of-steps"},
};
enum { N_OUTCOMES = sizeof OUTCOMES / sizeof *OUTCOMES };

const char *hn_extreme_outcome(hn_status status) {
    for (int i = 0; i < N_OUTCOMES; i++) {
        if (OUTCOMES[i].status == status) {
            return OUTCOMES[i].word;
        }
    }
    return "failed";
}

const char *const *hn_extreme_outcomes(int *n) {
    static const char *const words[] = {
        "finished",   "refused",        "unreachable", "inconsistent", "singular", "no-convergence",
        "chart-lost", "step-underflow", "diverged",    "out-of-steps", "ended"};
    *n = sizeof words / sizeof *words;
    return words;
}

// ---- verdicts ----

const char *hn_extreme_verdict_name(hn_extreme_verdict verdict) {
    static const char *const names[] = {
#define HN_VERDICT_NAME(code, name) name,
        HN_VERDICT_LIST(HN_VERDICT_NAME)
#undef HN_VERDICT_NAME
    };
    return names[verdict];
}

static hn_extreme_verdict judge_number(const hn_extreme_expect *e, double value) {
    if (isnan(value)) {
        return HN_EXTREME_FAIL;
    }
    if (value >= e->low && value <= e->high) {
        return HN_EXTREME_PASS;
    }
    return value >= e->warn_low && value <= e->warn_high ? HN_EXTREME_WARN : HN_EXTREME_FAIL;
}

/// Returns the worst verdict of all numbers; for words: pass, warn or fail where all, some or none
/// are as predicted.
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
        snprintf(t->observed, sizeof t->observed, "%s%s%.199s", t->seen[0].word,
                 t->seen[0].reason[0] && t->n_seen == 1 ? ": " : "",
                 t->n_seen == 1 ? t->seen[0].reason : "");
    } else {
        snprintf(t->observed, sizeof t->observed, "%d of %d; %s %s%s%.199s", good, t->n_seen,
                 first->method, first->word, first->reason[0] ? ": " : "", first->reason);
    }
}

static void tell_numbers(hn_extreme_trial *t) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < t->n_seen; i++) {
        if (isnan(t->seen[i].value)) {
            snprintf(t->observed, sizeof t->observed, "%.199s", t->seen[i].reason);
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

void hn_extreme_conclude(hn_extreme_trial *t) {
    t->n_seen = t->n_scenes * t->n_methods;
    t->verdict = judge(t);
    if (t->expect.word) {
        tell_words(t);
    } else {
        tell_numbers(t);
    }
}
