// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/budgets/budgets_plot.h"

#include "session/budgets/budgets.h"

#include "base/units.h"
#include "session/precision/study_page.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 900, LABELS = 196, RIGHT = 744 };
enum { SIGNED_TEXT = HN_SI_TEXT + 4 }; // a sign may take three bytes
enum { BAR_TOP = 58, BAR_ROW = 62, BAR = 24, FEWEST_PIXELS = 1, SAID_MOST = 4 };
static const double LETTER = 6.6; // about the width of one in a label [px]
static const double SAID = 0.01;  // parts below this share of the largest are not named

/// The parts of one bar, of an error or of an energy.
typedef struct parts {
    int n;
    const char *name[HN_CAUSE_COUNT];
    double value[HN_CAUSE_COUNT];
    double whole; ///< what they are parts of
    const char *unit;
    char of[120]; ///< "th1 at the end"
} parts;

/// 0 where the budget has no such parts.
static int take_parts(const hn_model *model, const hn_budget_row *row, int energy, parts *p) {
    const hn_budget *a = &row->budget;
    const hn_coordinate *c = hn_budget_coordinate(model, row);
    if (row->status != HN_OK || (!energy && !c)) {
        return 0;
    }
    p->n = energy ? (int)HN_ENERGY_COUNT : (int)HN_CAUSE_COUNT;
    p->unit = energy ? "J" : hn_coordinate_unit(c, "1");
    p->whole = energy ? a->energy : a->error;
    snprintf(p->of, sizeof p->of, energy ? "change of energy" : "error of %.60s",
             energy ? "" : c->name);
    for (int i = 0; i < p->n; i++) {
        p->name[i] = energy ? hn_energy_item_words((hn_energy_item)i)->name
                            : hn_cause_words((hn_cause)i)->name;
        p->value[i] = hn_budget_part(row, energy, i);
    }
    return isfinite(p->whole);
}

bool hn_budgets_can_plot(const hn_budget_row *rows, int n, int energy) {
    for (int i = 0; i < n; i++) {
        if (rows[i].status == HN_OK && (energy || rows[i].budget.coordinate >= 0)) {
            return true;
        }
    }
    return false;
}

static void format_signed(double value, const char *unit, char out[SIGNED_TEXT]) {
    char text[HN_SI_TEXT];
    hn_si_format(fabs(value), unit, 3, text);
    snprintf(out, SIGNED_TEXT, "%s%s", value < 0 ? "\xe2\x88\x92" : "+", text);
}

/// Draws positive parts to the right of the middle, negative ones to the left; `largest` fills half
/// the width.
static void put_bar(hn_strbuf *b, const parts *p, double y, double largest) {
    const double middle = (LABELS + RIGHT) / 2.0, scale = (RIGHT - LABELS) / 2.0 / largest;
    double right = middle, left = middle;
    for (int i = 0; i < p->n; i++) {
        const double width = fabs(p->value[i]) * scale;
        char amount[SIGNED_TEXT];

        // parts too narrow to see, and NaN, are not drawn
        if (!(width >= FEWEST_PIXELS)) {
            continue;
        }

        // place the part on its side, outside those before it
        const double x = p->value[i] > 0 ? right : left - width;
        right += p->value[i] > 0 ? width : 0;
        left -= p->value[i] > 0 ? 0 : width;

        // the amount appears on pointing
        format_signed(p->value[i], p->unit, amount);
        hn_strbuf_printf(b, "<g class=\"part\"><title>%s: %s</title>", p->name[i], amount);
        hn_strbuf_printf(b,
                         "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%d\" "
                         "style=\"fill:var(--slot-%d)\"/>",
                         x, y, width, BAR, hn_look_slot(i));

        // the name is written inside where it fits
        if (width > LETTER * (double)strlen(p->name[i]) + 6) {
            hn_plot_text(b, x + width / 2, y + BAR / 2.0 + 4, "inside middle", p->name[i]);
        }
        hn_strbuf_add(b, "</g>");
    }

    // the line of zero
    hn_strbuf_printf(b, "<path class=\"axis\" d=\"M%.1f %.1fV%.1f\"/>", middle, y - 4, y + BAR + 4);
}

/// Writes the largest few parts under the bar, for paper and for parts too narrow to see.
static void put_words(hn_strbuf *b, const parts *p, double y, double largest) {
    int said[HN_CAUSE_COUNT] = {0};
    hn_strbuf_printf(b, "<text x=\"%d\" y=\"%.1f\" class=\"note\">", LABELS, y);
    for (int count = 0; count < SAID_MOST; count++) {
        int next = -1;
        for (int i = 0; i < p->n; i++) {
            if (!said[i] && fabs(p->value[i]) > SAID * largest &&
                (next < 0 || fabs(p->value[i]) > fabs(p->value[next]))) {
                next = i;
            }
        }
        if (next < 0) {
            break;
        }
        char amount[SIGNED_TEXT];
        said[next] = 1;
        format_signed(p->value[next], p->unit, amount);
        hn_strbuf_printf(b, "%s%s %s", count ? ", " : "", p->name[next], amount);
    }
    hn_strbuf_add(b, "</text>");
}

static double largest_side(const parts *p) {
    double right = 0, left = 0;
    for (int i = 0; i < p->n; i++) {
        right += p->value[i] > 0 ? p->value[i] : 0;
        left -= p->value[i] < 0 ? p->value[i] : 0;
    }
    return fmax(right, left);
}

static void put_budget(hn_strbuf *b, const hn_model *model, const hn_budget_row *a, int energy,
                       double y) {
    parts p = {0};
    char amount[SIGNED_TEXT], text[200];

    // the name of the method, or why it has no budget
    hn_plot_text(b, 0, y + BAR / 2.0 + 4, "label", a->spelling);
    if (!take_parts(model, a, energy, &p)) {
        snprintf(text, sizeof text, "%.110s", a->reason[0] ? a->reason : "no budget");
        hn_plot_text(b, LABELS, y + BAR / 2.0 + 4, "note", text);
        return;
    }

    // the bars; where the parts do not add up to the error a note replaces them
    const double largest = largest_side(&p);
    char note[HN_BUDGET_NOTE] = "";
    if (!energy) {
        hn_budget_note(model, a, note);
    }
    if (note[0]) {
        hn_plot_text(b, LABELS, y + BAR / 2.0 + 4, "note", note);
    } else if (largest > 0) {
        put_bar(b, &p, y, largest);
        put_words(b, &p, y + BAR + 16, largest);
    }

    // the whole amount to the right, and when the run ended early
    format_signed(p.whole, p.unit, amount);
    hn_plot_text(b, RIGHT + 12, y + 10, "label", amount);
    hn_plot_text(b, RIGHT + 12, y + 26, "note", p.of);
    if (a->budget.state == HN_RUN_FAILED) {
        snprintf(text, sizeof text, "run ended at t = %.3g s", a->budget.t);
        hn_plot_text(b, RIGHT + 12, y + 42, "note", text);
    }
}

void hn_budgets_plot(hn_strbuf *b, const hn_model *model, const hn_budget_row *rows, int n,
                     int energy) {
    const char *title = energy ? "causes that put energy in (right) or took it out (left)"
                               : "where the error at the end comes from, signed";
    hn_plot_begin(b, WIDTH, BAR_TOP + BAR_ROW * n, title);
    hn_plot_text(b, 0, 14, "title", title);
    hn_plot_text(b, 0, 34, "note",
                 energy ? "each bar has its own scale; its parts add up to the number on the right"
                        : "each bar has its own scale; its parts add up, to first order, to the "
                          "number on the right");
    for (int i = 0; i < n; i++) {
        put_budget(b, model, &rows[i], energy, BAR_TOP + BAR_ROW * i);
    }
    hn_strbuf_add(b, "</svg>");
}
