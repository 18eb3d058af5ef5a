// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_html.h"

#include "session/style/style.h"

#include "session/precision/study_page.h"

#include "base/hash.h"
#include "base/units.h"
#include "render/look.h"
#include "study/run/timing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

void hn_page_theme(hn_strbuf *b, hn_theme theme) {
    const hn_surface *s = hn_surface_get(theme);
    hn_strbuf_printf(
        b, "--paper:#%06X;--raised:#%06X;--ink:#%06X;--muted:#%06X;--hairline:#%06X;--tear:#%06X;",
        (unsigned)s->paper, (unsigned)s->raised, (unsigned)s->ink, (unsigned)s->muted,
        (unsigned)s->hairline, (unsigned)s->tear);
    for (int slot = 0; slot < HN_LOOK_SLOTS; slot++) {
        hn_strbuf_printf(b, "--slot-%d:#%06X;", slot, (unsigned)hn_look_get(slot)->colour[theme]);
    }
}

/// Rules by which the radio buttons show one plot and mark what is chosen.
static void put_choices_style(hn_strbuf *b) {
    // show the plot of the chosen error and cost
    for (int e = 0; e < HN_ERROR_COUNT; e++) {
        for (int c = 0; c < HN_COST_COUNT; c++) {
            hn_strbuf_printf(b, "%s#e%d:checked~#c%d:checked~.plots .e%d.c%d", e + c ? "," : "", e,
                             c, e, c);
        }
    }
    hn_strbuf_add(b, "{display:block}");

    // mark the labels of what is chosen
    for (int i = 0; i < HN_ERROR_COUNT + HN_COST_COUNT; i++) {
        const int e = i < HN_ERROR_COUNT;
        const int n = e ? i : i - HN_ERROR_COUNT;
        hn_strbuf_printf(b, "%s#%c%d:checked~* label[for=%c%d]", i ? "," : "", e ? 'e' : 'c', n,
                         e ? 'e' : 'c', n);
    }
    hn_strbuf_add(b, "{background:var(--raised);box-shadow:inset 0 -2px var(--ink)}");

    // keyboard focus
    for (int i = 0; i < HN_ERROR_COUNT + HN_COST_COUNT; i++) {
        const int e = i < HN_ERROR_COUNT;
        const int n = e ? i : i - HN_ERROR_COUNT;
        hn_strbuf_printf(b, "%s#%c%d:focus-visible~* label[for=%c%d]", i ? "," : "", e ? 'e' : 'c',
                         n, e ? 'e' : 'c', n);
    }
    hn_strbuf_add(b, "{outline:2px solid var(--ink)}");
}

void hn_page_head(hn_strbuf *b, const char *title, const char *style) {
    hn_strbuf_add(b, "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                     "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
                     "<meta name=\"color-scheme\" content=\"light dark\"><title>");
    hn_html_text(b, title);
    hn_strbuf_add(b, "</title><style>:root{");
    hn_page_theme(b, HN_THEME_LIGHT);
    hn_strbuf_add(b, "}@media screen and (prefers-color-scheme:dark){:root{");
    hn_page_theme(b, HN_THEME_DARK);
    hn_strbuf_add(b, "}}");
    hn_strbuf_add(b, hn_style_plots);
    hn_strbuf_add(b, hn_style_page);
    put_choices_style(b);
    hn_strbuf_add(b, style);
    hn_strbuf_add(b, "</style></head><body><main>\n");
}

void hn_page_lines(hn_strbuf *b, const char *text) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        hn_strbuf_add(b, "<li>");
        hn_html_text_n(b, text, n);
        hn_strbuf_add(b, "</li>");
        text += n + (text[n] == '\n');
    }
}

void hn_page_scroll(hn_strbuf *b, const char *name) {
    hn_strbuf_add(b, "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"");
    hn_html_text(b, name);
    hn_strbuf_add(b, "\">");
}

void hn_page_table(hn_strbuf *b, const char *name) {
    hn_page_scroll(b, name);
    hn_strbuf_add(b, "<table>");
}

static void put_head(hn_strbuf *b, int level, const char *text) {
    hn_strbuf_printf(b, "<h%d>%s</h%d>", level, text, level);
}

void hn_study_put_method(hn_strbuf *b, const hn_study *s, int m) {
    hn_strbuf_add(b, "<th scope=\"row\" class=\"m\">");
    hn_study_key(b, m);
    hn_strbuf_add(b, " ");
    hn_html_text(b, hn_study_wp(s)->methods[m].spelling);
    hn_strbuf_add(b, "</th>");
}

// answers ----

bool hn_study_is_timed(const hn_study *s) {
    const hn_wp *wp = hn_study_wp(s);
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            if (wp->methods[m].point[k].n_samples > 0) {
                return true;
            }
        }
    }
    return false;
}

static void put_answer(hn_strbuf *b, const hn_study *s, hn_error_kind error, hn_cost_kind cost) {
    hn_pareto p;
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_wp_pareto(hn_study_wp(s), hn_study_classes(s), error, cost, &p);
    hn_pareto_sentences(&text, hn_study_wp(s), &p);
    hn_strbuf_printf(
        b, "<p class=\"quiet\">Cheapest by %s, for the error of the %s</p><ul class=\"answers\">",
        cost == HN_COST_TIME ? "CPU time" : hn_cost_name(cost), hn_error_title(error));
    hn_page_lines(b, hn_strbuf_text(&text));
    hn_strbuf_add(b, p.n_bands || p.beyond_horizon
                         ? "</ul>"
                         : "<li>No run has an error of 0.1 or less.</li></ul>");
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

void hn_study_put_answers(hn_strbuf *b, const hn_study *s) {
    const hn_error_kind error = hn_wp_ranked_error(hn_study_wp(s));
    if (hn_study_is_timed(s)) {
        put_answer(b, s, error, HN_COST_TIME);
    }
    put_answer(b, s, error, HN_COST_OPS);
    if (error != HN_ERROR_Q) {
        put_answer(b, s, HN_ERROR_Q, HN_COST_OPS);
    }
}

// the table of methods ----

static double claimed(const hn_wp *wp, const hn_wp_point *p, hn_error_kind kind) {
    return fmax(p->worst[kind], HN_WP_ABOVE_REFERENCE * wp->ref->error[kind]);
}

/// Returns the coarsest point with the smallest error that the reference resolves, or NULL.
static const hn_wp_point *best_point(const hn_wp *wp, int m) {
    const hn_wp_point *best = NULL;
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (p->state == HN_WP_DONE &&
            (!best || claimed(wp, p, HN_ERROR_Q) < claimed(wp, best, HN_ERROR_Q))) {
            best = p;
        }
    }
    return best;
}

static void put_error(hn_strbuf *b, const hn_wp *wp, const hn_wp_point *p, hn_error_kind kind) {
    if (!p || !isfinite(p->worst[kind])) {
        hn_strbuf_add(b, "<td class=\"n\">–</td>");
    } else {
        hn_strbuf_printf(b, "<td class=\"n\">%s%.1e</td>",
                         p->worst[kind] < claimed(wp, p, kind) ? "&lt; " : "",
                         claimed(wp, p, kind));
    }
}

static void put_quantity(hn_strbuf *b, double value, const char *unit) {
    char text[HN_SI_TEXT];
    hn_si_format(value, unit, 3, text);
    hn_strbuf_printf(b, "<td class=\"n\">%s</td>", isfinite(value) ? text : "–");
}

void hn_study_put_methods(hn_strbuf *b, const hn_study *s, int level) {
    const hn_wp *wp = hn_study_wp(s);
    put_head(b, level, "Methods");
    hn_strbuf_add(b, "<p class=\"quiet\">The verdict follows from all sizes of step or tolerance; "
                     "the numbers are those of the most accurate run. A closed loop does not make "
                     "a motion right: a gap of 1e-16 says nothing about the other columns.</p>");

    // head of the table
    hn_page_table(b, "Methods");
    hn_strbuf_add(b, "<thead><tr><th>method</th><th>verdict</th><th class=\"n\">done</th>");
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        hn_strbuf_printf(b, "<th class=\"n\">%s</th>",
                         i == HN_ERROR_VELOCITY_GAP ? "speed gap"
                                                    : hn_error_title((hn_error_kind)i));
    }
    hn_strbuf_add(b, "<th class=\"n\">CPU</th><th class=\"n\">operations</th></tr></thead><tbody>");

    // one row per method
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_wp_point *best = best_point(wp, m);
        const hn_class *c = &hn_study_classes(s)[m];
        int done = 0;
        for (int k = 0; k < wp->n_levels; k++) {
            done += wp->methods[m].point[k].state == HN_WP_DONE;
        }

        // name, verdict, share of complete points
        hn_strbuf_add(b, "<tr>");
        hn_study_put_method(b, s, m);
        hn_strbuf_printf(b, "<td class=\"v%s\">", c->kind == HN_CLASS_ELSEWHERE ? " wrong" : "");
        hn_html_text(b, c->text);
        hn_strbuf_printf(b, "</td><td class=\"n\">%d of %d</td>", done, wp->n_levels);

        // errors and cost of the most accurate point
        for (int i = 0; i < HN_ERROR_COUNT; i++) {
            put_error(b, wp, best, (hn_error_kind)i);
        }
        put_quantity(b, best ? best->median : (double)NAN, "s");
        put_quantity(b, best ? hn_cost_known_ops(&best->cost) : (double)NAN, "op");
        hn_strbuf_add(b, "</tr>");
    }
    hn_strbuf_add(b, "</tbody></table></div>\n");
}

void hn_study_put_race(hn_strbuf *b, const hn_study *s, int level) {
    const hn_wp *wp = hn_study_wp(s);
    hn_race race;
    const hn_error_kind error = hn_wp_ranked_error(wp);
    hn_wp_race(wp, hn_study_classes(s), error, &race);
    if (race.n == 0) {
        return;
    }

    // heading
    put_head(b, level, "What equal cost buys");
    hn_strbuf_printf(b,
                     "<p class=\"quiet\">Error of the %s for the same number of operations, "
                     "interpolated between measured points. ≤: a cheaper run already has this "
                     "error. –: every run of the method costs more.</p>",
                     hn_error_title(error));

    // costs as columns
    hn_page_table(b, "What equal cost buys");
    hn_strbuf_add(b, "<thead><tr><th>method</th>");
    for (int i = 0; i < race.n; i++) {
        char text[HN_SI_TEXT];
        hn_si_format(race.cost[i], "op", 2, text);
        hn_strbuf_printf(b, "<th class=\"n\">%s</th>", text);
    }
    hn_strbuf_add(b, "</tr></thead><tbody>");

    // one row per method
    for (int m = 0; m < wp->n_methods; m++) {
        hn_strbuf_add(b, "<tr>");
        hn_study_put_method(b, s, m);
        for (int i = 0; i < race.n; i++) {
            const double e = race.error[i][m];
            hn_strbuf_add(b, "<td class=\"n\">");
            hn_strbuf_add(b, race.is_bound[i][m] ? "≤ " : "");
            hn_strbuf_printf(b, isfinite(e) ? "%.1e</td>" : "–</td>", e);
        }
        hn_strbuf_add(b, "</tr>");
    }
    hn_strbuf_add(b, "</tbody></table></div>\n");
}

// every point ----

static void put_point(hn_strbuf *b, const hn_study *s, int m, int k) {
    const hn_wp *wp = hn_study_wp(s);
    const hn_wp_point *p = &wp->methods[m].point[k];
    const int done = p->state == HN_WP_DONE;

    // method, size, steps
    hn_strbuf_add(b, "<tr>");
    hn_study_put_method(b, s, m);
    hn_strbuf_printf(b, "<td class=\"n\">%.3g</td><td class=\"n\">%lld</td>", p->size, p->steps);

    // errors, or across their columns the reason of the failure
    for (int i = 0; i < HN_ERROR_COUNT && done; i++) {
        put_error(b, wp, p, (hn_error_kind)i);
    }
    if (!done) {
        hn_strbuf_printf(b, "<td colspan=\"%d\" class=\"wrong\">", HN_ERROR_COUNT);
        if (p->t_reached > 0) {
            hn_strbuf_printf(b, "ended at t = %.4g s: ", p->t_reached);
        }
        hn_html_text(b, p->reason[0] ? p->reason : "not run: the study was stopped");
        hn_strbuf_add(b, "</td>");
    }

    // cost
    put_quantity(b, done ? p->median : (double)NAN, "s");
    hn_strbuf_printf(
        b, isfinite(p->spread) ? "<td class=\"n\">%.0f %%%s</td>" : "<td class=\"n\">–</td>",
        100 * p->spread, p->busy ? " (busy)" : "");
    hn_strbuf_printf(b, "<td class=\"n\">%lld</td>", p->cost.evals);
    put_quantity(b, hn_cost_known_ops(&p->cost), "op");
    hn_strbuf_add(b, "</tr>");
}

void hn_study_put_points(hn_strbuf *b, const hn_study *s) {
    const hn_wp *wp = hn_study_wp(s);
    hn_strbuf_add(b, "<details class=\"all\"><summary>Every point</summary>");
    hn_page_table(b, "Every point");
    hn_strbuf_add(b, "<thead><tr><th>method</th><th class=\"n\">h or rtol</th>"
                     "<th class=\"n\">steps</th>");
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        hn_strbuf_printf(b, "<th class=\"n\">%s</th>", hn_error_title((hn_error_kind)i));
    }
    hn_strbuf_add(
        b, "<th class=\"n\">CPU</th><th class=\"n\">spread</th><th class=\"n\">evaluations</th>"
           "<th class=\"n\">operations</th></tr></thead><tbody>");
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            put_point(b, s, m, k);
        }
    }
    hn_strbuf_add(b, "</tbody></table></div></details>\n");
}

/// Writes the list of failed points with their reasons; it is printed on paper too.
void hn_study_put_failures(hn_strbuf *b, const hn_study *s, int level) {
    const hn_wp *wp = hn_study_wp(s);
    int any = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            char spelling[HN_SPEC_MAX];
            if (p->state == HN_WP_DONE) {
                continue;
            }

            // the heading appears with the first failure only
            hn_wp_spelling(wp, m, k, spelling);
            if (!any++) {
                put_head(b, level, "Runs that did not reach the end");
                hn_strbuf_add(b, "<ul class=\"answers\">");
            }

            // method, time and reason
            hn_strbuf_add(b, "<li>");
            hn_html_text(b, spelling);
            if (p->t_reached > 0) {
                hn_strbuf_printf(b, " ended at t = %.4g s", p->t_reached);
            }
            hn_strbuf_add(b, ": ");
            hn_html_text(b, p->reason[0] ? p->reason : "not run: the study was stopped");
            hn_strbuf_add(b, "</li>");
        }
    }
    hn_strbuf_add(b, any ? "</ul>\n" : "");
}

// plots and words ----

static void put_bar(hn_strbuf *b, const char *name, char letter, int n, const char *(*title)(int)) {
    hn_strbuf_printf(b, "<div class=\"bar\"><span>%s</span>", name);
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(b, "<label for=\"%c%d\">%s</label>", letter, i, title(i));
    }
    hn_strbuf_add(b, "</div>");
}

static const char *error_title(int i) {
    return hn_error_title((hn_error_kind)i);
}

static const char *cost_title(int i) {
    return i == HN_COST_TIME ? "CPU time" : hn_cost_name((hn_cost_kind)i);
}

void hn_page_choices(hn_strbuf *b, hn_cost_kind first) {
    for (int e = 0; e < HN_ERROR_COUNT; e++) {
        hn_strbuf_printf(b,
                         "<input class=\"choice\" type=\"radio\" name=\"e\" id=\"e%d\" "
                         "aria-label=\"error of the %s\"%s>",
                         e, hn_error_title((hn_error_kind)e), e == HN_ERROR_Q ? " checked" : "");
    }
    for (int c = 0; c < HN_COST_COUNT; c++) {
        hn_strbuf_printf(b,
                         "<input class=\"choice\" type=\"radio\" name=\"c\" id=\"c%d\" "
                         "aria-label=\"against %s\"%s>",
                         c, cost_title(c), c == (int)first ? " checked" : "");
    }
    hn_strbuf_add(b, "<div class=\"bars\">");
    put_bar(b, "error of", 'e', HN_ERROR_COUNT, error_title);
    put_bar(b, "against", 'c', HN_COST_COUNT, cost_title);
    hn_strbuf_add(b, "</div>");
}

void hn_study_put_plots(hn_strbuf *b, const hn_study *s) {
    for (int e = 0; e < HN_ERROR_COUNT; e++) {
        for (int c = 0; c < HN_COST_COUNT; c++) {
            hn_strbuf_printf(b, "<div class=\"plot e%d c%d\">", e, c);
            hn_study_plot(b, s, (hn_error_kind)e, (hn_cost_kind)c);
            hn_strbuf_add(b, "</div>\n");
        }
    }
}

static void put_plots(hn_strbuf *b, const hn_study *s) {
    hn_strbuf_add(b, "<h2>Error against cost</h2><section>");
    hn_page_choices(b, hn_study_is_timed(s) ? HN_COST_TIME : HN_COST_OPS);
    hn_strbuf_add(b, "<div class=\"plots\">");
    hn_study_put_plots(b, s);
    hn_strbuf_add(
        b, "</div></section><p class=\"quiet\">Down is more accurate, left is cheaper. A cross "
           "on the upper edge is a run that ended early, at what it had cost by then. A "
           "faint curve converges to another motion.</p>\n");
}

void hn_study_put_chaos(hn_strbuf *b, const hn_study *s) {
    const hn_chaos *c = hn_study_chaos(s);
    hn_strbuf_printf(b, "<p class=\"quiet%s\">Chaos: ", c->chaotic ? " wrong" : "");
    hn_html_text(b, c->why);
    hn_strbuf_add(b, ".");
    if (hn_study_wp(s)->horizon > 0) {
        hn_strbuf_printf(b, " A difference of %.0e has grown to %g by t = %.3g s.", HN_STUDY_TINY,
                         HN_STUDY_LARGE, hn_study_wp(s)->horizon);
    }
    hn_strbuf_add(b, "</p>");
}

static void put_intro(hn_strbuf *b, const hn_study *s) {
    const hn_scene *scene = hn_model_scene(hn_study_model(s));
    const hn_wp *wp = hn_study_wp(s);
    char hex[17];
    hn_hash_hex(scene->hash, hex);
    hn_strbuf_add(b, "<h1>");
    hn_html_text(b, scene->title ? scene->title : scene->id);
    hn_strbuf_printf(b,
                     "</h1><p class=\"quiet\">error against cost, to t = %g s, %d method%s, %d "
                     "sizes each; scene ",
                     wp->ref->T, wp->n_methods, wp->n_methods == 1 ? "" : "s", wp->n_levels);
    hn_html_text(b, scene->id ? scene->id : "");
    hn_strbuf_printf(b, " %s</p>", hex);
    hn_study_put_chaos(b, s);
    if (wp->stopped || wp->out_of_time) {
        hn_strbuf_printf(b, "<p class=\"wrong\">%s; the missing ones are listed below.</p>",
                         wp->stopped ? "This study was stopped before it was complete"
                                     : "The time limit was too short for all points and samples");
    }
}

void hn_study_put_measures(hn_strbuf *b, const hn_study *s, int level) {
    const hn_ref *ref = hn_study_wp(s)->ref;
    const double digits = hn_ref_digits(ref);
    char agree[120] = "shares no digit of the coordinates with it at the end";
    if (digits >= 1) {
        snprintf(agree, sizeof agree,
                 "agrees to %.1f digits of the coordinates and to %.1e of the "
                 "reactions",
                 digits, ref->error[HN_ERROR_REACTION]);
    }
    put_head(b, level, "How it was measured");
    hn_strbuf_printf(b,
                     "<p>The reference solution is %s; %s, which has only the scene's equations in "
                     "common with it, %s. Errors below ten times their difference are given as "
                     "bounds.</p>",
                     ref->means[0], ref->means[1], agree);
    hn_strbuf_add(b, "<p>In this study ");
    hn_study_put_times(b, s);
    hn_strbuf_printf(
        b,
        ". Coordinates: lengths over %.3g m, angles in rad, never modulo a turn. Rates: over the "
        "largest of the reference, %.3g 1/s. Reactions: J'(λ − λ_ref) over the largest J'λ_ref. "
        "Gaps: over the same length and rate. Energy: over the largest kinetic energy plus the "
        "range of the potential, %.3g J.</p>",
        ref->scales.length, ref->scales.rate, ref->scales.energy);
}

void hn_page_timing(hn_strbuf *b) {
    hn_strbuf_printf(
        b,
        "<p>CPU time is the median of up to %d samples of one run without output, each a batch of "
        "%g ms or more, taken in rounds over all points. Spread is the distance of the quartiles "
        "over the median; “busy” marks points whose wall time exceeded the CPU time by more than "
        "%.0f %%. Halfway every run is repeated from its start, so that the samples form two "
        "measurements. Times are ranked only where the medians of both halves agree within %.0f "
        "%%, and the methods differ by more than %.0f %% and by more than their quartiles and "
        "halves do. Evaluations and operations are exact.</p>\n",
        HN_WP_SAMPLES, 1e3 * HN_TIMING_BATCH, 100 * (HN_WP_BUSY - 1), 100 * (HN_PARETO_STEADY - 1),
        100 * (HN_PARETO_CLOSE - 1));
}

void hn_study_html(hn_strbuf *b, const hn_study *s) {
    const hn_scene *scene = hn_model_scene(hn_study_model(s));
    char title[200];
    snprintf(title, sizeof title, "%.160s: error against cost",
             scene->title ? scene->title : scene->id);
    hn_page_head(b, title, "");
    put_intro(b, s);
    hn_strbuf_add(b, "<h2>Which method for which accuracy</h2>");
    hn_study_put_answers(b, s);
    put_plots(b, s);
    hn_study_put_methods(b, s, 2);
    hn_study_put_race(b, s, 2);
    hn_study_put_failures(b, s, 2);
    hn_study_put_measures(b, s, 2);
    hn_page_timing(b);
    hn_study_put_points(b, s);
    hn_strbuf_add(b, "</main></body></html>\n");
}
