// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/report/report_html.h"

#include "session/style/style.h"

#include "session/report/report_internal.h"

#include "base/units.h"
#include "session/budgets/budgets_plot.h"
#include "session/precision/study_html.h"
#include "session/precision/study_page.h"
#include "session/report/report_plot.h"
#include "session/report/report_words.h"

#include <math.h>
#include <stdio.h>

static const char SCRIPT[] =
    "(function(){'use strict';var "
    "d=document,main=d.querySelector('main'),tip=d.createElement('div')"
    ";tip.className='tip';tip.hidden=true;d.body.appendChild(tip);main.classList.add('script');"
    "var held=new WeakMap();"
    "function target(e){return e.target.closest&&e.target.closest('.point,.failed,.part,.mark')}"
    "function words(g){if(!held.has(g)){var t=g.querySelector('title');held.set(g,t?t.textContent:"
    "'');if(t){g.setAttribute('aria-label',t.textContent);t.remove()}}return held.get(g)}"
    "d.addEventListener('pointerover',function(e){var g=target(e);tip.hidden=!g;if(!g)return;"
    "tip.textContent=words(g);var r=g.getBoundingClientRect(),w=tip.offsetWidth,h=tip.offsetHeight;"
    "tip.style.left=Math.max(4,Math.min(innerWidth-w-4,r.left+r.width/2-w/2))+'px';"
    "tip.style.top=(r.top>h+12?r.top-h-8:r.bottom+8)+'px'});"
    "d.addEventListener('scroll',function(){tip.hidden=true},{passive:true});"
    "function toggle(m){var off=main.classList.toggle('hide-'+m);"
    "var b=d.querySelector('.names button[data-m=\"'+m+'\"]');"
    "if(b)b.setAttribute('aria-pressed',String(!off))}"
    "d.addEventListener('click',function(e){var g=e.target.closest&&"
    "e.target.closest('.entry,.names button');if(g)toggle(g.getAttribute('data-m'))});"
    "var folded=[];addEventListener('beforeprint',function(){folded=[].slice.call("
    "d.querySelectorAll('section>details:not([open])'));folded.forEach(function(f){f.open=true})});"
    "addEventListener('afterprint',function(){folded.forEach(function(f){f.open=false});"
    "folded=[]})})();";

static const char *title_of(const hn_report_scene *s) {
    const hn_scene *scene = hn_model_scene(s->model);
    return scene->title ? scene->title : scene->id ? scene->id : "scene";
}

/// Writes the style that hides a method that is switched off.
static void put_hiding_style(hn_strbuf *b) {
    for (int m = 0; m < HN_WP_METHODS; m++) {
        hn_strbuf_printf(b, ".hide-%d .plot .series[data-m=\"%d\"]{display:none}", m, m);
        hn_strbuf_printf(b, ".hide-%d .entry[data-m=\"%d\"]{opacity:.3}", m, m);
    }
}

// the first screen ----

static void put_answer(hn_strbuf *b, const hn_report_scene *s, double accuracy) {
    const hn_report_answer a = hn_report_find_answer(s, accuracy);
    char cost[HN_SI_TEXT];
    if (a.method < 0) {
        hn_strbuf_add(b, "<td class=\"none\">none</td>");
        return;
    }
    hn_si_format(a.cost, a.by == HN_COST_TIME ? "s" : "op", 2, cost);
    hn_strbuf_add(b, "<td>");
    hn_study_key(b, a.method);
    hn_strbuf_add(b, " ");
    hn_html_text(b, hn_study_wp(s->study)->methods[a.method].spelling);
    hn_strbuf_printf(b, " <small>%s", cost);
    if (a.n_alike > 0) {
        hn_strbuf_printf(b, ", %d alike", a.n_alike);
    }
    hn_strbuf_add(b, "</small></td>");
}

static void put_answers(hn_strbuf *b, const hn_report *r) {
    // the head of the table: the accuracies
    hn_strbuf_add(b, "<h2>The cheapest method, for an error of the coordinates of</h2>");
    hn_page_table(b, "The cheapest method");
    hn_strbuf_add(b, "<thead><tr><th>scene</th>");
    for (int i = 0; i < HN_REPORT_BANDS; i++) {
        hn_strbuf_printf(b, "<th>10<sup>%.0f</sup></th>", log10(hn_report_accuracy[i]));
    }
    hn_strbuf_add(b, "</tr></thead><tbody>");

    // a row for each scene
    for (int i = 0; i < r->n; i++) {
        const hn_report_scene *s = &r->scenes[i];

        // its title links to its section
        hn_strbuf_printf(b, "<tr><th scope=\"row\"><a href=\"#scene-%d\">", i + 1);
        hn_html_text(b, title_of(s));
        hn_strbuf_add(b, "</a> <small>");
        hn_html_text(b, hn_report_scene_id(s));
        hn_strbuf_add(b, "</small>");

        // mark scenes where errors are taken from the energy
        if (s->study && hn_wp_is_beyond_horizon(hn_study_wp(s->study))) {
            hn_strbuf_add(b, " <small>chaotic: by energy</small>");
        }
        hn_strbuf_add(b, "</th>");

        // its cheapest methods, or why it has no study
        for (int k = 0; k < HN_REPORT_BANDS && s->study; k++) {
            put_answer(b, s, hn_report_accuracy[k]);
        }
        if (!s->study) {
            hn_strbuf_printf(b, "<td class=\"wrong\" colspan=\"%d\">", HN_REPORT_BANDS);
            hn_html_text(b, s->reason);
            hn_strbuf_add(b, "</td>");
        }
        hn_strbuf_add(b, "</tr>");
    }

    // how to read the table
    hn_strbuf_add(b, "</tbody></table></div><p class=\"quiet\">Seconds: CPU time of the run, where "
                     "two measurements agree and the next method is clearly slower. Operations "
                     "(op): elsewhere methods are ranked by arithmetic operations. “2 alike”: two "
                     "other methods need as few.</p>");
}

static void put_verdict(hn_strbuf *b, const hn_report_scene *s, int m) {
    // no study: a dash
    if (!s->study) {
        hn_strbuf_add(b, "<td class=\"none\">–</td>");
        return;
    }

    // the verdict, with its reason shown on pointing
    const hn_verdict v = hn_report_find_verdict(s, m);
    const int none = v.kind == HN_VERDICT_REFUSED || v.kind == HN_VERDICT_NOT_RUN;
    hn_strbuf_printf(b, "<td%s title=\"",
                     v.untrusted ? " class=\"wrong\""
                     : none      ? " class=\"none\""
                                 : "");
    hn_html_text(b, v.why);
    hn_strbuf_printf(b, "\">%s", v.text);

    // what was left out, and how many sizes survive singular poses
    if (v.skipped > 0 && v.done > 0) {
        hn_strbuf_printf(b, "<small>, %d left out</small>", v.skipped);
    }
    if (s->strips && s->strips[m].n > 0) {
        hn_strbuf_printf(b, "<small>, survives %d/%d</small>", hn_strip_survived(&s->strips[m]),
                         s->strips[m].n);
    }
    hn_strbuf_add(b, "</td>");
}

static void put_verdicts(hn_strbuf *b, const hn_report *r) {
    // without any study there is no list of methods
    const hn_study *any = hn_report_any_study(r);
    if (!any) {
        return;
    }

    // the head of the table: the scenes
    hn_strbuf_add(b,
                  "<h2>What each method reaches: smallest error of the coordinates, and where it "
                  "fails</h2>");
    hn_page_table(b, "What each method reaches");
    hn_strbuf_add(b, "<thead><tr><th>method</th>");
    for (int i = 0; i < r->n; i++) {
        hn_strbuf_printf(b, "<th><a href=\"#scene-%d\">", i + 1);
        hn_html_text(b, hn_report_scene_id(&r->scenes[i]));
        hn_strbuf_add(b, "</a></th>");
    }
    hn_strbuf_add(b, "</tr></thead><tbody>");

    // a row for each method
    for (int m = 0; m < hn_study_wp(any)->n_methods; m++) {
        hn_strbuf_add(b, "<tr>");
        hn_study_put_method(b, any, m);
        for (int i = 0; i < r->n; i++) {
            put_verdict(b, &r->scenes[i], m);
        }
        hn_strbuf_add(b, "</tr>");
    }

    // how to read the table
    hn_strbuf_add(b,
                  "</tbody></table></div><p class=\"quiet\">“3 of 7 fail”: with three of seven "
                  "sizes of step or tolerance the run did not reach the end. “3 left out”: three "
                  "finer sizes were not run, to keep the time limit; the method may be more "
                  "accurate than shown. “no digit”: no error is below 0.1. “elsewhere”: the method "
                  "converges, but to another motion. “survives n/m”: of m other step sizes, n "
                  "passed the singular configurations with an error of at most 1e-2.</p>\n");
}

static void put_sentences(hn_strbuf *b, const hn_report *r) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_report_sentences(&text, r);
    if (text.n > 0) {
        hn_strbuf_add(b, "<ul class=\"answers\">");
        hn_page_lines(b, hn_strbuf_text(&text));
        hn_strbuf_add(b, "</ul>");
    }
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

static void put_top(hn_strbuf *b, const hn_report *r) {
    const hn_study *any = hn_report_any_study(r);
    hn_strbuf_printf(b,
                     "<h1>Which method should I use, and what does accuracy cost?</h1>"
                     "<p class=\"quiet\">%d scenes, %d methods, %d sizes each; made in %.0f s",
                     r->n, r->request.n_methods, any ? hn_study_wp(any)->n_levels : 0, r->elapsed);
    if (r->request.build) {
        hn_strbuf_add(b, " by holonom ");
        hn_html_text(b, r->request.build);
    }
    hn_strbuf_add(b, "; one thread, and no other work while time is measured</p>");
    if (r->stopped) {
        hn_strbuf_add(b, "<p class=\"wrong\">The report was stopped before it was complete; the "
                         "same command continues it.</p>");
    }
    put_sentences(b, r);
    hn_strbuf_add(b, "<div class=\"top\">");
    put_answers(b, r);
    put_verdicts(b, r);
    hn_strbuf_add(b, "</div>\n");
}

// a scene ----

static void put_budgets(hn_strbuf *b, const hn_report_scene *s) {
    // the heading names what there is
    const int error = hn_budgets_can_plot(s->budgets, s->n_budgets, 0);
    const int energy = hn_budgets_can_plot(s->budgets, s->n_budgets, 1);
    if (error || energy) {
        hn_strbuf_printf(b, "<h3>Where %senergy come%s from</h3>", error ? "errors and " : "",
                         error ? "" : "s");
    }

    // why the budget of errors, or both, is missing
    if (!error) {
        hn_strbuf_printf(
            b, "<p class=\"quiet\">No budget of %s: ", energy ? "errors" : "errors and energy");
        hn_html_text(b, s->n_budgets > 0 ? s->budgets[0].reason : "the report was stopped");
        hn_strbuf_add(b, ".</p>");
    }

    // the plots
    for (int k = 0; k < 2; k++) {
        if (k ? energy : error) {
            hn_strbuf_add(b, "<div class=\"lines\">");
            hn_page_scroll(b, k ? "budget of energy" : "budget of the error");
            hn_budgets_plot(b, s->model, s->budgets, s->n_budgets, k);
            hn_strbuf_add(b, "</div></div>\n");
        }
    }
}

static void put_survival(hn_strbuf *b, const hn_report_scene *s) {
    if (!s->strips) {
        return;
    }
    hn_strbuf_printf(
        b,
        "<h3>Through singular configurations</h3><p class=\"quiet\">The mechanism reaches its "
        "first singular configuration at t = %.3g s. Each mark is a run: its step or tolerance to "
        "the right, the time it reached upwards. Runs that survive are on the upper line.</p>",
        s->singular_at);
    hn_page_scroll(b, "sizes that survive");
    hn_report_survival_plot(b, s);
    hn_strbuf_add(b, "</div>\n");
}

static void put_wrong_models(hn_strbuf *b, const hn_report_scene *s) {
    const hn_wp *wp = hn_study_wp(s->study);
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_class *c = &hn_study_classes(s->study)[m];
        if (c->kind == HN_CLASS_ELSEWHERE) {
            hn_strbuf_add(b, "<p class=\"wrong\">");
            hn_html_text(b, wp->methods[m].spelling);
            hn_strbuf_add(b, " ");
            hn_html_text(b, c->text);
            hn_strbuf_add(b, ".</p>");
        }
    }
}

static void put_scene(hn_strbuf *b, const hn_report_scene *s, int i) {
    // the heading
    hn_strbuf_printf(b,
                     "<section id=\"scene-%d\" aria-labelledby=\"title-%d\"><h2 id=\"title-%d\">",
                     i + 1, i + 1, i + 1);
    hn_html_text(b, title_of(s));
    hn_strbuf_add(b, "</h2>");

    // a scene without a study: why
    if (!s->study) {
        hn_strbuf_add(b, "<p class=\"wrong\">");
        hn_html_text(b, s->reason);
        hn_strbuf_add(b, "</p></section>\n");
        return;
    }

    // say when the time limit left results out
    const hn_wp *wp = hn_study_wp(s->study);
    if (wp->out_of_time || wp->stopped) {
        hn_strbuf_add(b, "<p class=\"quiet\">The time limit was too short for the finer sizes or "
                         "for all samples of time; the missing ones are listed below.</p>");
    }

    // the plots and the answers
    put_wrong_models(b, s);
    hn_page_scroll(b, "error against cost");
    hn_study_put_plots(b, s->study);
    hn_strbuf_add(b, "</div>");
    hn_study_put_answers(b, s->study);
    hn_study_put_chaos(b, s->study);

    // errors, energy, survival
    put_budgets(b, s);
    put_survival(b, s);

    // details are folded away
    hn_strbuf_add(b, "<details><summary>Methods, equal cost, failures, how it was measured, every "
                     "point</summary>");
    hn_study_put_methods(b, s->study, 3);
    hn_study_put_race(b, s->study, 3);
    hn_study_put_failures(b, s->study, 3);
    hn_study_put_measures(b, s->study, 3);
    hn_study_put_points(b, s->study);
    hn_strbuf_add(b, "</details></section>\n");
}

/// Returns the cost that plots show first: time if every scene was timed, else operations.
static hn_cost_kind first_cost(const hn_report *r) {
    for (int i = 0; i < r->n; i++) {
        hn_pareto p;
        if (r->scenes[i].study) {
            hn_wp_pareto(hn_study_wp(r->scenes[i].study), hn_study_classes(r->scenes[i].study),
                         HN_ERROR_ENERGY, HN_COST_TIME, &p);
            if (p.few || !hn_study_is_timed(r->scenes[i].study)) {
                return HN_COST_OPS;
            }
        }
    }
    return hn_report_any_study(r) ? HN_COST_TIME : HN_COST_OPS;
}

static void put_names(hn_strbuf *b, const hn_study *any) {
    hn_strbuf_add(b, "<div class=\"names\" role=\"group\" aria-label=\"methods shown\">");
    for (int m = 0; any && m < hn_study_wp(any)->n_methods; m++) {
        hn_strbuf_printf(b, "<button type=\"button\" data-m=\"%d\" aria-pressed=\"true\">", m);
        hn_study_key(b, m);
        hn_strbuf_add(b, " ");
        hn_html_text(b, hn_study_wp(any)->methods[m].spelling);
        hn_strbuf_add(b, "</button>");
    }
    hn_strbuf_add(b, "</div>");
}

void hn_report_html(hn_strbuf *b, const hn_report *r) {
    const hn_study *any = hn_report_any_study(r);

    // the head of the page, with the style of hidden methods
    hn_strbuf style;
    hn_strbuf_init(&style);
    hn_strbuf_add(&style, hn_style_report);
    put_hiding_style(&style);
    hn_page_head(b, "Methods for mechanisms with closed loops: the report", hn_strbuf_text(&style));
    b->failed |= style.failed;
    hn_strbuf_reset(&style);

    // the first screen
    put_top(b, r);
    hn_page_choices(b, first_cost(r));

    // the plots of every scene
    hn_strbuf_add(b, "<div class=\"plots\">");
    put_names(b, any);
    hn_strbuf_add(b,
                  "<p class=\"quiet\">Down is more accurate, left is cheaper. A cross on the upper "
                  "edge is a run that ended early, at what it had cost by then; a faint curve "
                  "converges to another motion; the grey band is what the reference cannot "
                  "resolve.</p>");
    for (int i = 0; i < r->n; i++) {
        put_scene(b, &r->scenes[i], i);
    }

    // how times were measured, and the script
    hn_strbuf_add(b,
                  "<section aria-labelledby=\"timing\"><h2 id=\"timing\">How time was taken</h2>");
    hn_page_timing(b);
    hn_strbuf_add(b, "</section></div></main><script>");
    hn_strbuf_add(b, SCRIPT);
    hn_strbuf_add(b, "</script></body></html>\n");
}
