// What a report says in short, and the whole of it as JSON.
#include "session/report_internal.h"

#include <math.h>
#include <stdio.h>

const double hn_report_accuracy[HN_REPORT_BANDS] = {1e-3, 1e-6, 1e-9};

static const double NO_DIGIT = 0.1; // errors from here on

static const hn_band *band_at(const hn_pareto *p, const hn_band *bands, double accuracy) {
    for (int i = 0; i < p->n_bands; i++) {
        if (bands[i].accuracy < accuracy * 1.01 && bands[i].accuracy > accuracy * 0.99 &&
            bands[i].best.level >= 0) {
            return &bands[i];
        }
    }
    return NULL;
}

hn_report_answer hn_report_find_answer(const hn_report_scene *s, double accuracy) {
    const hn_wp *wp = hn_study_wp(s->study);
    const hn_class *classes = hn_study_classes(s->study);
    const hn_error_kind error = hn_wp_ranked_error(wp);
    hn_pareto p;
    hn_wp_pareto(wp, classes, error, HN_COST_TIME, &p);
    const hn_band *band = band_at(&p, p.band, accuracy);
    if (band && band->ranking == HN_RANKING_CLEAR && !p.few && !p.clocks_differ) {
        return (hn_report_answer){band->best.method, band->best.cost, HN_COST_TIME, 0};
    }
    hn_wp_pareto(wp, classes, error, HN_COST_OPS, &p);
    band = band_at(&p, p.band, accuracy);
    return band ? (hn_report_answer){band->best.method, band->best.cost, HN_COST_OPS, band->n_close}
                : (hn_report_answer){-1, (double)NAN, HN_COST_OPS, 0};
}

static void count_points(const hn_wp *wp, int m, hn_verdict *v) {
    const hn_error_kind error = hn_wp_ranked_error(wp);
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        v->done += p->state == HN_WP_DONE;
        v->failed += p->state == HN_WP_FAILED;
        v->skipped += p->state == HN_WP_SKIPPED || p->state == HN_WP_PENDING;
        if (p->state == HN_WP_FAILED && !v->why) {
            v->why = p->reason;
            v->kind = p->status == HN_ERR_UNSUPPORTED ? HN_VERDICT_REFUSED : HN_VERDICT_FAILS;
        }
        if (p->state == HN_WP_DONE && isfinite(p->worst[error])) {
            const double e = fmax(p->worst[error], HN_WP_ABOVE_REFERENCE * wp->ref->error[error]);
            v->best = isnan(v->best) ? e : fmin(v->best, e);
        }
    }
}

hn_verdict hn_report_find_verdict(const hn_report_scene *s, int m) {
    const hn_wp *wp = hn_study_wp(s->study);
    const hn_class *c = &hn_study_classes(s->study)[m];
    hn_verdict v = {.kind = HN_VERDICT_NOT_RUN, .best = (double)NAN};
    count_points(wp, m, &v);
    if (c->kind == HN_CLASS_ELSEWHERE) {
        v.kind = HN_VERDICT_ELSEWHERE;
        v.why = c->text;
        snprintf(v.text, sizeof v.text, "elsewhere, by %.0e", c->offset);
    } else if (v.done == 0) {
        snprintf(v.text, sizeof v.text, "%s",
                 v.kind == HN_VERDICT_REFUSED ? "does not apply"
                 : v.kind == HN_VERDICT_FAILS ? "fails"
                                              : "not run");
    } else {
        v.kind = v.failed > 0 ? HN_VERDICT_PARTLY : HN_VERDICT_GOOD;
        v.why = v.why ? v.why : c->text;
        char best[24] = "no digit";
        if (v.best < NO_DIGIT) {
            snprintf(best, sizeof best, "%.0e", v.best);
        }
        snprintf(v.text, sizeof v.text, v.failed > 0 ? "%s, %d of %d fail" : "%s", best, v.failed,
                 v.failed + v.done);
    }
    v.why = v.why ? v.why : "left out to keep the budget";
    return v;
}

// JSON ---------------------------------------------------------------------------------------------------------------

static void put_strip(hn_strbuf *b, const hn_report_scene *s, int m) {
    const hn_strip *strip = &s->strips[m];
    hn_json_object(b);
    hn_json_put_string(b, "method", hn_study_wp(s->study)->methods[m].spelling);
    hn_json_put_int(b, "survived", hn_strip_survived(strip));
    hn_json_put_int(b, "tried", strip->n);
    hn_json_put_string(b, "reason", strip->reason);
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
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    if (!s->study) {
        hn_json_put_string(b, "reason", s->reason);
        hn_json_end_object(b);
        return;
    }
    put_answers(b, s);
    put_study(b, s->study);
    hn_json_key(b, "accounts");
    hn_json_array(b);
    for (int i = 0; i < s->n_accounts; i++) {
        hn_account_put(b, s->model, &s->accounts[i]);
    }
    hn_json_end_array(b);
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
    hn_json_put_number(b, "budget", r->request.budget);
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
