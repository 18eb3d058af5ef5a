// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/report/report_plot.h"

#include "session/style/style.h"

#include "session/report/report_internal.h"

#include "base/units.h"
#include "session/budgets/budgets_plot.h"
#include "session/precision/study_html.h"
#include "session/precision/study_page.h"
#include "session/report/report_words.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 900, LABELS = 196, RIGHT = 744 };
enum { STRIP_TOP = 62, STRIP_ROW = 38, STRIP = 26, STRIP_BOTTOM = 36 };
static const double LETTER = 6.6; // about the width of one in a label [px]

// survival ----

static const char *const SIGNS[HN_SURVIVAL_ENDS] = {
    [HN_SURVIVAL_SURVIVED] = "M0-5V5",
    [HN_SURVIVAL_OFF] = "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0Z",
    [HN_SURVIVAL_STOPPED] = "M-4-4L4 4M4-4L-4 4",
    [HN_SURVIVAL_TOLD] = "M0-5L5 4H-5Z",
    [HN_SURVIVAL_SILENT] = "M-4-4H4V4H-4Z",
};
static const char *const MEANINGS[HN_SURVIVAL_ENDS] = {
    [HN_SURVIVAL_SURVIVED] = "survived",
    [HN_SURVIVAL_OFF] = "inaccurate from here",
    [HN_SURVIVAL_STOPPED] = "ended early, with a reason",
    [HN_SURVIVAL_TOLD] = "wrong, with a report",
    [HN_SURVIVAL_SILENT] = "wrong, without a report",
};

static void put_sign(hn_strbuf *b, hn_survival_end end, double x, double y) {
    hn_strbuf_printf(b, "<path class=\"sign %s\" transform=\"translate(%.1f %.1f)\" d=\"%s\"/>",
                     hn_survival_name(end), x, y, SIGNS[end]);
}

static void put_signs_legend(hn_strbuf *b) {
    double x = 6;
    for (int end = 0; end < HN_SURVIVAL_SILENT;
         end++) { // without 'silent', which a reference cannot show
        put_sign(b, (hn_survival_end)end, x, 31);
        hn_plot_text(b, x + 10, 35, "note", MEANINGS[end]);
        x += 34 + LETTER * (double)strlen(MEANINGS[end]);
    }
}

/// Returns the place of a step size: fine at the left, coarse at the right.
static double across(int adaptive, double size, double usual) {
    const double low = hn_survival_step(usual, 0, HN_REPORT_SIZES);
    const double high = hn_survival_step(usual, HN_REPORT_SIZES - 1, HN_REPORT_SIZES);
    const double share = adaptive ? (log10(size) + 9) / 6 : (size - low) / (high - low);
    return LABELS + 8 + share * (RIGHT - LABELS - 16);
}

static void put_run(hn_strbuf *b, const hn_wp_method *m, double size, const hn_survival *run,
                    double T, double usual, double top) {
    const double x = across(m->adaptive, size, usual);
    const double y = top + STRIP * (1 - fmin(1, fmax(0, run->t / T)));
    hn_strbuf_printf(b, "<g class=\"mark\"><title>%s = %.3g: %s", m->adaptive ? "rtol" : "h", size,
                     hn_survival_name(run->end));
    if (run->end == HN_SURVIVAL_SURVIVED) {
        hn_strbuf_printf(b, ", error at most %.1e", run->worst);
    } else {
        hn_strbuf_printf(b, " at t = %.3g s%s", run->t, run->reason[0] ? ": " : "");
        hn_html_text(b, run->reason);
    }
    hn_strbuf_add(b, "</title>");
    if (run->end != HN_SURVIVAL_SURVIVED) { // how far it came
        hn_strbuf_printf(b, "<path class=\"way\" d=\"M%.1f %.1fV%.1f\"/>", x, top + STRIP, y);
    }
    put_sign(b, run->end, x, y);
    hn_strbuf_add(b, "</g>");
}

static void put_strip(hn_strbuf *b, const hn_report_scene *s, int m, double top) {
    const hn_wp *wp = hn_study_wp(s->study);
    const hn_strip *strip = &s->strips[m];
    char text[80];
    hn_strbuf_printf(b, "<g class=\"series\" data-m=\"%d\">", m);
    hn_plot_text(b, 0, top + STRIP / 2.0 + 4, "label", wp->methods[m].spelling);
    hn_strbuf_printf(b, "<path class=\"grid\" d=\"M%d %.1fH%dM%d %.1fH%d\"/>", LABELS, top, RIGHT,
                     LABELS, top + STRIP, RIGHT);
    for (int i = 0; i < strip->n; i++) {
        put_run(b, &wp->methods[m], strip->size[i], &strip->run[i], wp->ref->T,
                hn_model_scene(s->model)->step, top);
    }
    if (strip->n > 0) {
        snprintf(text, sizeof text, "survived %d of %d", hn_strip_survived(strip), strip->n);
    } else {
        snprintf(text, sizeof text, "not tried");
    }
    hn_plot_text(b, RIGHT + 12, top + STRIP / 2.0 + 4, strip->n > 0 ? "label" : "note", text);
    hn_strbuf_add(b, "</g>");
}

void hn_report_survival_plot(hn_strbuf *b, const hn_report_scene *s) {
    const hn_wp *wp = hn_study_wp(s->study);
    const double usual = hn_model_scene(s->model)->step;
    const int height = STRIP_TOP + STRIP_ROW * wp->n_methods + STRIP_BOTTOM;
    char title[120], axis[160], low[HN_SI_TEXT], high[HN_SI_TEXT];

    // the title, and the smallest and largest step as text
    snprintf(title, sizeof title, "step sizes that survive %.3g s through singular poses",
             wp->ref->T);
    hn_si_format(hn_survival_step(usual, 0, HN_REPORT_SIZES), "s", 2, low);
    hn_si_format(hn_survival_step(usual, HN_REPORT_SIZES - 1, HN_REPORT_SIZES), "s", 2, high);

    // the head of the picture
    hn_plot_begin(b, WIDTH, height, title);
    hn_plot_text(b, 0, 14, "title", title);
    put_signs_legend(b);

    // a strip for each method
    for (int m = 0; m < wp->n_methods; m++) {
        put_strip(b, s, m, STRIP_TOP + STRIP_ROW * m);
    }

    // the axes: time upwards, step size across
    snprintf(axis, sizeof axis, "%.3g s", wp->ref->T);
    hn_plot_text(b, LABELS - 4, STRIP_TOP + 4, "tick end", axis);
    hn_plot_text(b, LABELS - 4, STRIP_TOP + STRIP + 4, "tick end", "0");
    snprintf(axis, sizeof axis, "fine: h = %s, rtol = 1e-9", low);
    hn_plot_text(b, LABELS, height - 12, "tick", axis);
    snprintf(axis, sizeof axis, "coarse: h = %s, rtol = 1e-3", high);
    hn_plot_text(b, RIGHT, height - 12, "tick end", axis);
    hn_strbuf_add(b, "</svg>");
}

// files ----

enum { KIND_STUDY, KIND_ERRORS, KIND_ENERGY, KIND_SURVIVAL };
enum { PER_STUDY = HN_ERROR_COUNT * HN_COST_COUNT, PER_SCENE = PER_STUDY + 3 };

int hn_report_n_plots(const hn_report *r) {
    return r->n * PER_SCENE;
}

hn_report_plot hn_report_plot_at(const hn_report *r, int i) {
    hn_report_plot p = {.of = r, .scene = i / PER_SCENE};
    const char *id = hn_report_scene_id(&r->scenes[p.scene]);
    const int k = i % PER_SCENE;
    static const char *const names[] = {"", "where-errors-come-from", "energy-budget", "survival"};
    p.kind = k < PER_STUDY ? KIND_STUDY : KIND_ERRORS + k - PER_STUDY;
    p.error = k / HN_COST_COUNT;
    p.cost = k % HN_COST_COUNT;
    if (p.kind == KIND_STUDY) {
        snprintf(p.name, sizeof p.name, "%d-%.80s-%s-%s", p.scene + 1, id,
                 hn_error_name((hn_error_kind)p.error), hn_cost_name((hn_cost_kind)p.cost));
    } else {
        snprintf(p.name, sizeof p.name, "%d-%.80s-%s", p.scene + 1, id, names[p.kind]);
    }
    for (char *c = p.name; *c; c++) { // a scene of one's own may be called anything
        const int plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                          (*c >= '0' && *c <= '9') || *c == '-' || *c == '_';
        *c = plain ? *c : '-';
    }
    return p;
}

static bool draw(hn_strbuf *b, const hn_report_plot *p) {
    const hn_report_scene *s = &p->of->scenes[p->scene];
    const int timed = s->study && hn_study_is_timed(s->study);
    if (!s->study || (p->kind == KIND_STUDY && p->cost == HN_COST_TIME && !timed) ||
        (p->kind == KIND_SURVIVAL && !s->strips) ||
        ((p->kind == KIND_ERRORS || p->kind == KIND_ENERGY) &&
         !hn_budgets_can_plot(s->budgets, s->n_budgets, p->kind == KIND_ENERGY))) {
        return false;
    }
    if (p->kind == KIND_STUDY) {
        hn_study_plot(b, s->study, (hn_error_kind)p->error, (hn_cost_kind)p->cost);
    } else if (p->kind == KIND_SURVIVAL) {
        hn_report_survival_plot(b, s);
    } else {
        hn_budgets_plot(b, s->model, s->budgets, s->n_budgets, p->kind == KIND_ENERGY);
    }
    return strncmp(hn_strbuf_text(b), "<svg ", 5) ==
           0; // a paragraph says that nothing came to its end
}

/// The value of "NAME)..." in "--name:value;" pairs; 0: there is none.
static size_t find_variable(const char *theme, const char *name, const char **value) {
    const size_t n = strcspn(name, ")");
    for (const char *p = theme; *p; p += strcspn(p, ";") + 1) {
        if (strncmp(p, name, n) == 0 && p[n] == ':') {
            *value = p + n + 1;
            return strcspn(*value, ";");
        }
    }
    return 0;
}

/// Writes text with each var(--name) replaced by its value: some SVG readers know no variables.
static void put_resolved(hn_strbuf *b, const char *text, const char *theme) {
    for (const char *at; (at = strstr(text, "var(")) != NULL; text = at + strcspn(at, ")") + 1) {
        const char *value = NULL;
        const size_t n = find_variable(theme, at + 4, &value);
        hn_strbuf_add_n(b, text, (size_t)(at - text));
        hn_strbuf_add_n(b, value, n);
    }
    hn_strbuf_add(b, text);
}

bool hn_report_plot_svg(hn_strbuf *b, const hn_report_plot *p) {
    hn_strbuf inner, theme, whole;
    hn_strbuf_init(&inner);
    hn_strbuf_init(&theme);
    hn_strbuf_init(&whole);

    // draw the plot as it stands in a page
    const int drawn = draw(&inner, p);
    if (drawn) {
        // add what a file of its own needs: XML head, style, paper
        const char *body = strchr(hn_strbuf_text(&inner), '>') + 1;
        hn_page_theme(&theme, HN_THEME_LIGHT);
        hn_strbuf_add(&whole, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                              "<svg xmlns=\"http://www.w3.org/2000/svg\" ");
        hn_strbuf_add_n(&whole, hn_strbuf_text(&inner) + 5,
                        (size_t)(body - hn_strbuf_text(&inner)) - 5);
        hn_strbuf_add(&whole, "<style>");
        hn_strbuf_add(&whole, hn_style_plots);
        hn_strbuf_add(&whole, "</style><rect x=\"-12\" y=\"-12\" width=\"120%\" height=\"120%\" "
                              "style=\"fill:var(--paper)\"/>");
        hn_strbuf_add(&whole, body);

        // replace variables by the values of the light theme
        put_resolved(b, hn_strbuf_text(&whole), hn_strbuf_text(&theme));
    }

    b->failed |= inner.failed || theme.failed || whole.failed;
    hn_strbuf_reset(&inner);
    hn_strbuf_reset(&theme);
    hn_strbuf_reset(&whole);
    return drawn;
}
