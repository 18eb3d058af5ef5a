// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/report/report_words.h"

#include "session/report/report_internal.h"

#include "session/precision/study_html.h"
#include "session/precision/study_page.h"

#include <math.h>
#include <stdbool.h>
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

    // what became of each size
    count_points(wp, m, &v);
    // the verdict: elsewhere, nothing finished, or the smallest error with the failures
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

    // the reason, and whether any result can be trusted
    v.why = v.why ? v.why : "left out to keep the time limit";
    v.untrusted = v.kind == HN_VERDICT_FAILS || v.kind == HN_VERDICT_ELSEWHERE ||
                  (v.done > 0 && !(v.best < NO_DIGIT));
    return v;
}

// sentences ----

static const double DEPENDABLE = 1e-6; // the error that a method has to reach in every scene [-]

const hn_study *hn_report_any_study(const hn_report *r) {
    for (int i = 0; i < r->n; i++) {
        if (r->scenes[i].study) {
            return r->scenes[i].study;
        }
    }
    return NULL;
}

const char *hn_report_scene_id(const hn_report_scene *s) {
    const hn_scene *scene = hn_model_scene(s->model);
    return scene->id && scene->id[0] ? scene->id : "scene";
}

/// Appends `text`: after the lead-in if it is the first, else after a comma; counts in *said.
static void list(hn_strbuf *b, int *said, const char *before, const char *text) {
    hn_strbuf_printf(b, "%s%s", (*said)++ ? ", " : before, text);
}

/// "Cheapest: A in 11 of 18, B in 4, C in 3."
static void say_cheapest(hn_strbuf *b, const hn_report *r, const hn_wp *wp) {
    int times[HN_WP_METHODS] = {0}, n = 0, said = 0;
    for (int i = 0; i < r->n; i++) {
        for (int k = 0; k < HN_REPORT_BANDS && r->scenes[i].study; k++) {
            const int m = hn_report_find_answer(&r->scenes[i], hn_report_accuracy[k]).method;
            if (m >= 0) {
                times[m]++;
                n++;
            }
        }
    }
    for (int count = n; count > 0; count--) {
        for (int m = 0; m < wp->n_methods; m++) {
            if (times[m] == count) {
                list(b, &said, "Cheapest: ", wp->methods[m].spelling);
                hn_strbuf_printf(b, said > 1 ? " in %d" : " in %d of %d", count, n);
            }
        }
    }
    hn_strbuf_add(b, said ? ".\n" : "No method reaches any of these accuracies.\n");
}

/// Returns 1 if in every scene all tried sizes reached the end and the best reached that error.
static bool is_dependable(const hn_report *r, int m) {
    for (int i = 0; i < r->n; i++) {
        if (r->scenes[i].study) {
            const hn_verdict v = hn_report_find_verdict(&r->scenes[i], m);
            if (v.kind != HN_VERDICT_GOOD || !(v.best <= DEPENDABLE)) {
                return false;
            }
        }
    }
    return true;
}

static void say_dependable(hn_strbuf *b, const hn_report *r, const hn_wp *wp) {
    int said = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        if (is_dependable(r, m)) {
            list(b, &said,
                 "These methods reach the end at every size in every scene, with an error of 1e-6 "
                 "or less: ",
                 wp->methods[m].spelling);
        }
    }
    hn_strbuf_add(b, said ? ".\n"
                          : "No method reaches the end at every size in every scene with an error "
                            "of 1e-6 or less.\n");
}

static bool fails(const hn_verdict *v) {
    return v->kind != HN_VERDICT_ELSEWHERE && (v->untrusted || v->kind == HN_VERDICT_PARTLY);
}

static bool is_elsewhere(const hn_verdict *v) {
    return v->kind == HN_VERDICT_ELSEWHERE;
}

/// "WHAT in n-four-bar: A, B.", a line a scene; returns how many scenes there are.
static int say_where(hn_strbuf *b, const hn_report *r, const hn_wp *wp,
                     bool (*is)(const hn_verdict *), const char *what) {
    int scenes = 0;
    for (int i = 0; i < r->n; i++) {
        const hn_report_scene *s = &r->scenes[i];
        int said = 0;
        for (int m = 0; m < wp->n_methods && s->study; m++) {
            const hn_verdict v = hn_report_find_verdict(s, m);
            if (is(&v)) {
                if (!said) {
                    hn_strbuf_printf(b, "%s in %s", what, hn_report_scene_id(s));
                }
                list(b, &said, ": ", wp->methods[m].spelling);
            }
        }
        hn_strbuf_add(b, said ? ".\n" : "");
        scenes += said > 0;
    }
    return scenes;
}

static int is_few(const hn_report_scene *s) {
    const hn_wp *wp = hn_study_wp(s->study);
    hn_pareto p;
    hn_wp_pareto(wp, hn_study_classes(s->study), hn_wp_ranked_error(wp), HN_COST_TIME, &p);
    return p.few;
}

/// Writes how many answers are ranked by time, and why the others are not.
static void say_timed(hn_strbuf *b, const hn_report *r) {
    int answers = 0, by_time = 0, scenes = 0, timed = 0, few = 0;

    // count scenes, timed scenes and answers
    for (int i = 0; i < r->n; i++) {
        const hn_report_scene *s = &r->scenes[i];
        if (!s->study) {
            continue;
        }
        scenes++;
        timed += hn_study_is_timed(s->study);
        few += is_few(s);
        for (int k = 0; k < HN_REPORT_BANDS; k++) {
            const hn_report_answer a = hn_report_find_answer(s, hn_report_accuracy[k]);
            answers += a.method >= 0;
            by_time += a.method >= 0 && a.by == HN_COST_TIME;
        }
    }

    // say what decided the ranking
    if (timed == 0) {
        hn_strbuf_add(b, "Ranked by operations: no time was measured.\n");
    } else if (answers > 0) {
        hn_strbuf_printf(b, "Answers ranked by CPU time: %d of %d", by_time, answers);

        // say why the others are ranked by operations
        if (by_time < answers) {
            hn_strbuf_add(b, "; the others are ranked by operations, because ");
            if (few > 0) {
                hn_strbuf_printf(b, "points were timed fewer than %d times in %d of %d scenes",
                                 HN_WP_ENOUGH, few, scenes);
            } else {
                hn_strbuf_add(b, "their times do not repeat or differ too little");
            }
        }
        hn_strbuf_add(b, ".\n");
    }
}

void hn_report_sentences(hn_strbuf *b, const hn_report *r) {
    const hn_study *any = hn_report_any_study(r);
    if (!any) {
        return;
    }
    const hn_wp *wp = hn_study_wp(any);
    say_cheapest(b, r, wp);
    say_dependable(b, r, wp);
    if (say_where(b, r, wp, fails, "Methods that fail at some or all sizes") == 0) {
        hn_strbuf_add(b, "Nothing fails.\n");
    }
    say_where(b, r, wp, is_elsewhere, "Converge to another motion");
    say_timed(b, r);
}
