// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/report/report_doc.h"

#include "session/budgets/budgets_doc.h"
#include "session/precision/study_doc.h"
#include "session/report/report_internal.h"
#include "session/report/report_words.h"

#include <math.h>

static void put_strip(hn_strbuf *b, const hn_report_scene *s, int m) {
    const hn_strip *strip = &s->strips[m];
    hn_json_object(b);

    // the method and how many sizes it survived
    hn_json_put_string(b, "method", hn_study_wp(s->study)->methods[m].spelling);
    hn_json_put_int(b, "survived", hn_strip_survived(strip));
    hn_json_put_int(b, "tried", strip->n);
    hn_json_put_string(b, "reason", strip->reason);

    // every run
    hn_json_key(b, "runs");
    hn_json_array(b);
    for (int i = 0; i < strip->n; i++) {
        const hn_survival *run = &strip->run[i];
        hn_json_object(b);
        hn_json_put_number(b, "size", strip->size[i]);
        hn_json_put_string(b, "end", hn_survival_name(run->end));
        hn_json_put_number(b, "t", run->t);
        hn_json_put_number(b, "worst", run->worst);
        hn_json_put_string(b, "reason", run->reason);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_answers(hn_strbuf *b, const hn_report_scene *s) {
    const hn_wp *wp = hn_study_wp(s->study);

    // the cheapest method for each accuracy
    hn_json_key(b, "answers");
    hn_json_array(b);
    for (int i = 0; i < HN_REPORT_BANDS; i++) {
        const hn_report_answer a = hn_report_find_answer(s, hn_report_accuracy[i]);
        hn_json_object(b);
        hn_json_put_number(b, "accuracy", hn_report_accuracy[i]);
        hn_json_put_string(b, "method", a.method < 0 ? NULL : wp->methods[a.method].spelling);
        hn_json_put_string(b, "by", hn_cost_name(a.by));
        hn_json_put_number(b, "cost", a.cost);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);

    // the verdict on each method
    hn_json_key(b, "verdicts");
    hn_json_array(b);
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_verdict v = hn_report_find_verdict(s, m);
        hn_json_object(b);
        hn_json_put_string(b, "method", wp->methods[m].spelling);
        hn_json_put_string(b, "verdict", v.text);
        hn_json_put_string(b, "why", v.why);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

/// A study's document with commas of its own.
static void put_study(hn_strbuf *b, const hn_study *study) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_study_json(&text, study);
    hn_json_key(b, "study");
    hn_json_raw(b, hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

static void put_scene(hn_strbuf *b, const hn_report_scene *s) {
    const hn_scene *scene = hn_model_scene(s->model);
    hn_json_object(b);

    // the scene; without a study only the reason
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    if (!s->study) {
        hn_json_put_string(b, "reason", s->reason);
        hn_json_end_object(b);
        return;
    }

    // the study
    put_answers(b, s);
    put_study(b, s->study);

    // the budgets of errors and energy
    hn_json_key(b, "budgets");
    hn_json_array(b);
    for (int i = 0; i < s->n_budgets; i++) {
        hn_budget_put(b, s->model, &s->budgets[i]);
    }
    hn_json_end_array(b);

    // singular poses, and which step sizes survive them
    hn_json_put_number(b, "singular_at", s->singular ? s->singular_at : (double)NAN);
    if (s->strips) {
        hn_json_key(b, "survival");
        hn_json_array(b);
        for (int m = 0; m < hn_study_wp(s->study)->n_methods; m++) {
            put_strip(b, s, m);
        }
        hn_json_end_array(b);
    }
    hn_json_end_object(b);
}

void hn_report_json(hn_strbuf *b, const hn_report *r) {
    hn_json_object(b);
    hn_json_put_string(b, "report", "work-precision");
    hn_json_put_number(b, "time_limit", r->request.limits.time_limit);
    hn_json_put_number(b, "elapsed", r->elapsed);
    hn_json_put_bool(b, "stopped", r->stopped);
    hn_json_key(b, "scenes");
    hn_json_array(b);
    for (int i = 0; i < r->n; i++) {
        put_scene(b, &r->scenes[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
