// SPDX-License-Identifier: GPL-3.0-or-later
// A method with its options that meets an error target within a cost. The method of the answer is
// run on the scene, and its coordinates at the end are compared with those of the reference method.
#include "grade/parts/blank.h"
#include "grade/parts/part_list.h"
#include "grade/parts/part_model.h"

#include "integrators/method/guest.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_COORDINATES = 64, MAX_STEPS = 200000 };

/// Result of a run to the end.
typedef struct outcome {
    hn_status status;
    char reason[300];
    double t;
    int n;
    double q[MAX_COORDINATES];
    double gap, energy_change, evaluations;
} outcome;

static void finish(const hn_part *p, hn_run *run, double time, outcome *out) {
    hn_sample sample;
    out->status = hn_part_advance(p, run, time);
    const hn_run_summary summary = hn_run_get_summary(run);
    out->t = summary.t;
    out->gap = summary.worst_gap;
    out->energy_change = summary.worst_energy_change;
    out->evaluations = (double)summary.cost.evals;
    snprintf(out->reason, sizeof out->reason, "%.290s", summary.reason);
    if (out->status == HN_OK) {
        out->status = hn_run_sample(run, time, &sample);
    }
    for (int i = 0; i < out->n && out->status == HN_OK; i++) {
        out->q[i] = sample.q[i];
    }
}

/// Runs a method to the end. HN_ERR_INPUT, with a diag: the word names no method, or one that does
/// not support the scene.
static hn_status run_method(const hn_part *p, const hn_model *model, const char *word, outcome *out,
                            hn_diag *diag) {
    hn_method_spec spec;
    hn_run *run = NULL;
    const hn_system *sys = hn_model_system(model);
    hn_run_opts opts = hn_run_opts_default();
    const double time = hn_part_number(p->node, "time", 1);
    memset(out, 0, sizeof *out);
    out->n = hn_system_get_info(sys).n_user;
    out->n = out->n < MAX_COORDINATES ? out->n : MAX_COORDINATES;
    opts.t_end = time;
    opts.max_steps = MAX_STEPS;
    HN_TRY(hn_method_parse(word, &spec, diag));
    hn_status status =
        hn_run_create(sys, &spec, hn_model_q(model), hn_model_v(model), &opts, &run, diag);
    if (status == HN_OK) {
        finish(p, run, time, out);
    }
    hn_run_free(run);
    return status == HN_ERR_UNSUPPORTED ? HN_ERR_INPUT : status;
}

static double distance(const outcome *a, const outcome *b) {
    double worst = 0;
    for (int i = 0; i < a->n; i++) {
        worst = fmax(worst, fabs(a->q[i] - b->q[i]));
    }
    return worst;
}

/// Returns the measured quantity: the error against the reference, the loop gap, or the change of
/// energy.
static double measure(const hn_part *p, const outcome *found, const outcome *reference) {
    const char *what = hn_part_text(p->node, "measure");
    return strcmp(what, "gap") == 0      ? found->gap
           : strcmp(what, "energy") == 0 ? fabs(found->energy_change)
                                         : distance(found, reference);
}

static void judge(const hn_part *p, const outcome *found, const outcome *reference,
                  hn_part_result *r) {
    static const struct {
        const char *says, *unit;
    } measures[] = {{"a coordinate differs from the reference by", "rad or m"},
                    {"the loop gap reaches", "m"},
                    {"the energy changes by", "J"}};
    const char *what = hn_part_text(p->node, "measure");
    const int kind = strcmp(what, "gap") == 0 ? 1 : strcmp(what, "energy") == 0 ? 2 : 0;
    const double limit = hn_part_number(p->node, "error", 0),
                 cost = hn_part_number(p->node, "evaluations", HUGE_VAL);
    const double error = measure(p, found, reference);
    if (found->status != HN_OK) {
        hn_part_wrong(r, "ended-early", 0, "the run ended at t = %.4g s: %s", found->t,
                      found->reason);
    } else if (!(error <= limit)) {
        const int near = error <= 10 * limit && found->evaluations <= cost;
        hn_part_wrong(r, "inaccurate", near ? 0.5 : 0.25,
                      "%s %.3g %s; at most %.3g %s is allowed (%.0f evaluations)",
                      measures[kind].says, error, measures[kind].unit, limit, measures[kind].unit,
                      found->evaluations);
    } else if (found->evaluations > cost) {
        hn_part_wrong(r, "costly", 0.5,
                      "accurate enough (%.2g), but %.0f evaluations of the dynamics; allowed %.0f",
                      error, found->evaluations, cost);
    } else {
        hn_part_right(r);
    }
}

static hn_status grade_word(const hn_part *p, const char *word, hn_part_result *r, hn_diag *diag) {
    hn_model *model = NULL;
    outcome found, reference;
    hn_diag why = {0};
    HN_TRY(hn_part_load_model(p, &model, diag));
    hn_status status = run_method(p, model, hn_part_text(p->node, "reference"), &reference, diag);
    status = status == HN_OK && reference.status != HN_OK ? HN_ERR_INPUT : status;
    if (status == HN_OK) {
        const hn_status tried = run_method(p, model, word, &found, &why);
        if (tried == HN_OK) {
            judge(p, &found, &reference, r);
        } else {
            // the options that allow programs are not those of a student, and a list of all names
            // is longer than a verdict
            const char *list = strstr(why.message, "; there are: ");
            const int length = list ? (int)(list - why.message) : 250;
            const bool fits = (size_t)length + strlen(why.hint) + 3 < sizeof r->explanation;
            const bool named = why.hint[0] && fits && !hn_guest_is_named(word);
            hn_part_unreadable(r, "%.*s; %s", length, why.message,
                               named ? why.hint : "choose one of 'holonom list methods'");
            status = tried == HN_ERR_MEMORY ? tried : status;
        }
    }
    hn_model_free(model);
    return status;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    const char *word = cJSON_GetStringValue(given);
    if (!hn_part_begin(r, n, given, "a method within the limits")) {
        return HN_OK;
    }
    if (!word) {
        hn_part_unreadable(r, "expected a method in quotes");
        return HN_OK;
    }
    return grade_word(p, word, r, diag);
}

/// A second method agrees with the reference to a tenth of the error that is allowed.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    hn_model *model = NULL;
    outcome a, b;
    HN_TRY(hn_part_load_model(p, &model, diag));
    hn_status status = run_method(p, model, hn_part_text(p->node, "reference"), &a, diag);
    status =
        status == HN_OK ? run_method(p, model, hn_part_text(p->node, "second"), &b, diag) : status;
    const double limit = hn_part_number(p->node, "error", 0);
    const int measured = hn_part_text(p->node, "measure")[0] != 0;
    if (status == HN_OK && (a.status != HN_OK || b.status != HN_OK ||
                            (!measured && !(distance(&a, &b) <= limit / 10)))) {
        status =
            hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                        "part %s: two methods differ by %.3g at the end", p->id, distance(&a, &b));
    }
    hn_model_free(model);
    return status;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    hn_strbuf_printf(b,
                     "a method in quotes, as \"projection@rk4:h=0.01\"; it is run on the scene "
                     "%s to t = %g s",
                     hn_part_text(p->node, "scene"), hn_part_number(p->node, "time", 1));
    hn_part_put_settings(b, p);
}

const hn_part_kind hn_part_method = {
    .name = "method",
    .fields = "scene set time measure error evaluations reference second answer faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_text,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = prove,
};
