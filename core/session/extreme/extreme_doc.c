// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_doc.h"

#include "session/extreme/extreme_verdict.h"

#include "session/extreme/extreme_internal.h"
#include "session/store/csv.h"

#include <math.h>
#include <stdio.h>

static void put_expect(hn_strbuf *b, const hn_extreme_expect *e) {
    // the prediction: a word for an outcome, or a band for a number
    hn_json_key(b, "predicted");
    hn_json_object(b);
    hn_json_put_string(b, "text", e->text);
    if (e->word) {
        hn_json_put_string(b, "word", e->word);
        hn_json_put_string(b, "says", e->says);
    } else {
        hn_json_put_number(b, "low", e->low);
        hn_json_put_number(b, "high", e->high);
    }

    hn_json_put_string(b, "reason", e->reason);
    hn_json_put_string(b, "source", e->source);
    hn_json_end_object(b);

    // the earlier prediction, if this one corrects it
    hn_json_key(b, "corrected");
    if (!e->was) {
        hn_json_null(b);
        return;
    }
    hn_json_object(b);
    hn_json_put_string(b, "was", e->was);
    hn_json_put_string(b, "reason", e->was_why);
    hn_json_put_string(b, "source", e->was_source);
    hn_json_end_object(b);
}

static void put_seen(hn_strbuf *b, const hn_extreme_trial *t) {
    hn_json_key(b, "seen");
    hn_json_array(b);
    for (int i = 0; i < t->n_seen; i++) {
        const hn_extreme_seen *s = &t->seen[i];
        hn_json_object(b);
        hn_json_put_string(b, "scene", s->scene);
        hn_json_put_string(b, "method", s->method);
        if (t->expect.word) {
            hn_json_put_string(b, "word", s->word);
            hn_json_put_number(b, "share", s->value);
        } else {
            hn_json_put_number(b, "value", s->value);
        }
        hn_json_put_string(b, "reason", s->reason);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_trial(hn_strbuf *b, const hn_extreme_trial *t) {
    hn_json_object(b);
    hn_json_put_string(b, "what", t->what);
    hn_json_put_string(b, "measure", t->measure->name);
    hn_json_put_string(b, "of", t->of ? t->of->name : NULL);
    put_expect(b, &t->expect);
    hn_json_put_string(b, "observed", t->observed);
    hn_json_put_string(b, "verdict", hn_extreme_verdict_name(t->verdict));
    put_seen(b, t);
    hn_json_end_object(b);
}

void hn_extreme_json(hn_strbuf *b, const hn_extreme *x) {
    hn_json_object(b);
    hn_json_key(b, "cases");
    hn_json_array(b);

    // the cases, each with its trials
    for (int i = 0; i < x->n_cases; i++) {
        const hn_extreme_case *c = &x->cases[i];
        hn_json_object(b);
        hn_json_put_string(b, "id", c->id);
        hn_json_put_string(b, "title", c->title);
        hn_json_put_string(b, "why", c->why);
        hn_json_put_string(b, "about", c->about);
        hn_json_put_string(b, "verdict", hn_extreme_verdict_name(c->verdict));
        hn_json_key(b, "trials");
        hn_json_array(b);
        for (int k = 0; k < c->n_trials; k++) {
            put_trial(b, &c->trials[k]);
        }
        hn_json_end_array(b);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);

    // how many trials have each verdict
    hn_json_key(b, "counts");
    hn_json_object(b);
    for (int v = 0; v < HN_EXTREME_VERDICTS; v++) {
        const hn_extreme_verdict verdict = (hn_extreme_verdict)v;
        hn_json_put_int(b, hn_extreme_verdict_name(verdict), hn_extreme_count(x, verdict));
    }
    hn_json_end_object(b);

    // whether all trials were run
    hn_json_put_bool(b, "stopped", x->stopped);
    hn_json_put_bool(b, "out_of_time", x->out_of_time);
    hn_json_end_object(b);
}

void hn_extreme_csv(hn_strbuf *b, const hn_extreme *x) {
    hn_strbuf_add(b, "id,what,predicted,observed,verdict,reason,source,corrected\n");

    // a row for each trial
    for (int i = 0; i < x->n_cases; i++) {
        const hn_extreme_case *c = &x->cases[i];
        for (int k = 0; k < c->n_trials; k++) {
            const hn_extreme_trial *t = &c->trials[k];
            const char *cells[] = {c->id,
                                   t->what,
                                   t->expect.text,
                                   t->observed,
                                   hn_extreme_verdict_name(t->verdict),
                                   t->expect.reason,
                                   t->expect.source,
                                   t->expect.was_why};

            for (size_t j = 0; j < sizeof cells / sizeof *cells; j++) {
                hn_strbuf_add(b, j ? "," : "");
                hn_csv_text(b, cells[j]);
            }
            hn_strbuf_add(b, "\n");
        }
    }
}
