// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_read_expect.h"

#include "session/extreme/extreme_measure.h"
#include "session/extreme/extreme_reader.h"
#include "session/extreme/extreme_stable.h"
#include "session/extreme/extreme_verdict.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define WARN_TOLERANCES 3.0 // a number outside gives "warn" up to this many tolerances
#define WARN_FACTOR 10.0    // and beyond a one-sided bound up to this factor

static void set_band(hn_extreme_expect *e, double low, double high, double tolerance) {
    e->low = low;
    e->high = high;
    e->warn_low = low - (WARN_TOLERANCES - 1) * tolerance;
    e->warn_high = high + (WARN_TOLERANCES - 1) * tolerance;
}

/// Sets a one-sided bound; results within WARN_FACTOR beyond it give "warn". A bound of 0 has no
/// such range.
static void set_bounds(hn_extreme_expect *e, double low, double high) {
    e->low = low;
    e->high = high;
    e->warn_low = low > 0 ? low / WARN_FACTOR : low * WARN_FACTOR;
    e->warn_high = high > 0 ? high * WARN_FACTOR : high / WARN_FACTOR;
}

static void read_band(hn_xr *r, const cJSON *node, hn_extreme_expect *e) {
    const double value = hn_xr_number(r, node, "value", -HN_XR_NUMBER, HN_XR_NUMBER, (double)NAN);
    const double within = hn_xr_number(r, node, "within", 0, HN_XR_NUMBER, (double)NAN);
    const double share = hn_xr_number(r, node, "within_share", 0, 1, (double)NAN);
    if (isnan(within) == isnan(share)) {
        hn_xr_fault(r, "value", NULL, "a value needs either 'within' or 'within_share'");
    }
    const double tolerance = isnan(within) ? share * fabs(value) : within;
    set_band(e, value - tolerance, value + tolerance, tolerance);
    if (e->from_spectrum) {
        snprintf(e->text, sizeof e->text, "the spectrum's limit, %g %%", 100 * tolerance);
    } else if (isnan(within)) {
        snprintf(e->text, sizeof e->text, "%.6g, %g %%", value, 100 * share);
    } else {
        snprintf(e->text, sizeof e->text, "%.14g, within %g", value, within);
    }
}

static void read_between(hn_xr *r, const cJSON *node, hn_extreme_expect *e) {
    const cJSON *low = cJSON_GetArrayItem(node, 0), *high = cJSON_GetArrayItem(node, 1);
    if (!cJSON_IsArray(node) || cJSON_GetArraySize(node) != 2 || !cJSON_IsNumber(low) ||
        !cJSON_IsNumber(high) || !(low->valuedouble < high->valuedouble)) {
        hn_xr_fault(r, "between", NULL, "expected two numbers, the smaller one first");
        return;
    }
    const double half = (high->valuedouble - low->valuedouble) / 2;
    set_band(e, low->valuedouble, high->valuedouble, half);
    snprintf(e->text, sizeof e->text, "%.6g to %.6g", low->valuedouble, high->valuedouble);
}

static void read_word(hn_xr *r, const cJSON *node, hn_extreme_expect *e) {
    int n = 0, known = 0;
    const char *const *words = hn_extreme_outcomes(&n);
    e->word = hn_xr_text(r, node, "word", 1);
    e->says = hn_xr_text(r, node, "says", 0);
    for (int i = 0; i < n; i++) {
        known |= strcmp(words[i], e->word) == 0;
    }
    if (!known) {
        char hint[HN_DIAG_HINT] = "";
        hn_xr_suggest(hint, e->word, words, n);
        hn_xr_fault(r, "word", hint, "there is no outcome '%.60s'", e->word);
    }
    snprintf(e->text, sizeof e->text, e->says ? "%s: \"%s\"" : "%s", e->word, e->says);
}

/// Reads where a prediction comes from, and why it is expected.
static void read_origin(hn_xr *r, const cJSON *node, hn_extreme_expect *e) {
    const char *from = hn_xr_text(r, node, "from", 0);
    e->from_spectrum = from != NULL;
    if (from && strcmp(from, "spectrum") != 0) {
        hn_xr_fault(r, "from", "take \"spectrum\"",
                    "the only source of a prediction is 'spectrum'; otherwise leave 'from' out");
    }
    e->reason = hn_xr_text(r, node, "reason", 1);
    e->source = hn_xr_text(r, node, "source", 0);
}

/// Reads the one form of a prediction that is given: a band, a bound or a word.
static void read_form(hn_xr *r, const cJSON *node, hn_extreme_expect *e) {
    const double most = HN_XR_NUMBER;
    if (hn_xr_get(node, "value")) {
        read_band(r, node, e);
    } else if (hn_xr_get(node, "between")) {
        read_between(r, hn_xr_get(node, "between"), e);
    } else if (hn_xr_get(node, "word")) {
        read_word(r, node, e);
    } else if (hn_xr_get(node, "at_most")) {
        set_bounds(e, -HUGE_VAL, hn_xr_number(r, node, "at_most", -most, most, 0));
        snprintf(e->text, sizeof e->text, "at most %.6g", e->high);
    } else {
        set_bounds(e, hn_xr_number(r, node, "at_least", -most, most, 0), HUGE_VAL);
        snprintf(e->text, sizeof e->text, "at least %.6g", e->low);
    }
}

/// Checks that the trial's measure can give what is predicted; `one` says that the prediction has
/// one form.
static void check_measure(hn_xr *r, const hn_extreme_trial *t, bool one) {
    const hn_extreme_expect *e = &t->expect;
    if (!t->measure) {
        return;
    }

    // the spectrum predicts step limits only
    const bool stable_step = t->measure->see == hn_extreme_see_stable_step;
    if (e->from_spectrum && !stable_step) {
        hn_xr_fault(r, "from", NULL, "only 'stable-step' is predicted from the spectrum");
    }

    // a stable step needs one place to search: the spectrum's limit or 'limit'
    if (stable_step && (t->limit[0] > 0) == e->from_spectrum) {
        hn_xr_fault(
            r, "from", NULL,
            "'stable-step' needs either \"from\": \"spectrum\" or the two steps of 'limit'");
    }

    // the prediction must be of the kind that the measure gives
    if (t->measure->gives_word != (e->word != NULL) && one) {
        hn_xr_fault(r, NULL, NULL, "'%s' gives %s", t->measure->name,
                    t->measure->gives_word ? "a word" : "a number");
    }
}

void hn_xr_expect(hn_xr *r, const cJSON *root, hn_extreme_trial *t) {
    static const char *const forms[] = {"value", "at_most", "at_least", "between", "word"};
    const cJSON *node = hn_xr_get(root, "predicted");
    const size_t mark = hn_xr_enter(r, "predicted", -1);
    if (hn_xr_object(r, node,
                     HN_XR_FIELDS("value", "within", "within_share", "at_most", "at_least",
                                  "between", "word", "says", "from", "reason", "source"))) {
        read_origin(r, node, &t->expect);

        // exactly one form of prediction
        int given = 0;
        for (int i = 0; i < 5; i++) {
            given += hn_xr_get(node, forms[i]) != NULL;
        }
        if (given == 1) {
            read_form(r, node, &t->expect);
        } else {
            hn_xr_fault(
                r, NULL, NULL,
                "a prediction needs exactly one of value, at_most, at_least, between and word");
        }

        check_measure(r, t, given == 1);
    }
    hn_xr_leave(r, mark);
}

void hn_xr_corrected(hn_xr *r, const cJSON *root, hn_extreme_expect *e) {
    const cJSON *node = hn_xr_get(root, "corrected");
    if (!node) {
        return;
    }
    const size_t mark = hn_xr_enter(r, "corrected", -1);
    if (hn_xr_object(r, node, HN_XR_FIELDS("was", "reason", "source"))) {
        e->was = hn_xr_text(r, node, "was", 1);
        e->was_why = hn_xr_text(r, node, "reason", 1);
        e->was_source = hn_xr_text(r, node, "source", 1);
    }
    hn_xr_leave(r, mark);
}
