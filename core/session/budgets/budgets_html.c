// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/budgets/budgets_html.h"

#include "session/style/style.h"

#include "session/budgets/budgets_internal.h"

#include "base/units.h"
#include "session/budgets/budgets_plot.h"
#include "session/precision/study_html.h"
#include "session/precision/study_page.h"

#include <math.h>
#include <stdio.h>

/// A number in the unit of its budget, without a prefix: parts that are added have one unit.
static void put_part(hn_strbuf *b, double value) {
    char text[HN_SI_TEXT] = "\xe2\x80\x93";
    if (isfinite(value)) {
        snprintf(text, sizeof text, "%.3g", fabs(value));
    }
    hn_strbuf_printf(b, "<td class=\"n\">%s%s</td>", value < 0 ? "\xe2\x88\x92" : "", text);
}

static void put_head(hn_strbuf *b, int energy) {
    hn_strbuf_add(b, "<thead><tr><th>method</th><th>");
    hn_strbuf_add(b, energy ? "to t</th><th class=\"n\">change [J]"
                            : "error of</th><th class=\"n\">at the end");
    for (int k = 0; k < (energy ? (int)HN_ENERGY_COUNT : (int)HN_CAUSE_COUNT); k++) {
        hn_strbuf_printf(b, "</th><th class=\"n\">%s%s",
                         energy ? hn_energy_item_words((hn_energy_item)k)->name
                                : hn_cause_words((hn_cause)k)->name,
                         energy ? " [J]" : "");
    }
    hn_strbuf_add(b, energy ? "</th></tr></thead>"
                            : "</th><th class=\"n\">their sum</th></tr></thead>");
}

/// Writes a line of the table; none for a row without a budget or without an error at its end.
static void put_row(hn_strbuf *b, const hn_budgets *a, const hn_budget_row *row, int energy) {
    const hn_coordinate *c = hn_budget_coordinate(a->model, row);

    // a row without a budget has no line in this table
    if (row->status != HN_OK || (!energy && !c)) {
        return;
    }

    // the head of the line: the method, then the end time or the coordinate
    hn_strbuf_add(b, "<tr><th scope=\"row\" class=\"m\">");
    hn_html_text(b, row->spelling);
    hn_strbuf_add(b, "</th><td class=\"m\">");
    if (energy) {
        hn_strbuf_printf(b, "%.4g s", row->budget.t);
    } else {
        hn_html_text(b, c->name);
        hn_strbuf_printf(b, " [%s]", hn_coordinate_unit(c, "1"));
    }
    hn_strbuf_add(b, "</td>");

    // the whole, its parts, and for errors their sum
    put_part(b, energy ? row->budget.energy : row->budget.error);
    for (int k = 0; k < (energy ? (int)HN_ENERGY_COUNT : (int)HN_CAUSE_COUNT); k++) {
        put_part(b, hn_budget_part(row, energy, k));
    }
    if (!energy) {
        put_part(b, row->budget.sum);
    }
    hn_strbuf_add(b, "</tr>\n");
}

/// error = parts (energy = 0), change of energy = parts (1)
static void put_table(hn_strbuf *b, const hn_budgets *a, int energy) {
    hn_page_table(b, energy ? "budget of energy" : "budget of the error");
    put_head(b, energy);
    hn_strbuf_add(b, "<tbody>");
    for (int i = 0; i < a->n; i++) {
        put_row(b, a, &a->rows[i], energy);
    }
    hn_strbuf_add(b, "</tbody></table></div>");
}

static void put_reasons(hn_strbuf *b, const hn_budgets *a) {
    for (int i = 0; i < a->n; i++) {
        const hn_budget_row *row = &a->rows[i];
        if (row->reason[0]) {
            hn_strbuf_add(b, "<p class=\"wrong\">");
            hn_html_text(b, row->spelling);
            hn_strbuf_printf(b, ": %s, ", hn_budget_state(row));
            hn_html_text(b, row->reason);
            hn_strbuf_add(b, "</p>");
        }
        char note[HN_BUDGET_NOTE];
        hn_budget_note(a->model, row, note);
        if (note[0]) {
            hn_strbuf_add(b, "<p class=\"wrong\">");
            hn_html_text(b, row->spelling);
            hn_strbuf_add(b, ": ");
            hn_html_text(b, note);
            hn_strbuf_add(b, "</p>");
        }
    }
}

static void put_legend(hn_strbuf *b) {
    hn_strbuf_add(b, "<h2>What the words mean</h2><dl>");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, "<dt>%s</dt><dd>%s</dd>", hn_cause_words((hn_cause)i)->name,
                         hn_cause_words((hn_cause)i)->about);
    }
    for (int i = HN_ENERGY_LOOPS; i < HN_ENERGY_COUNT; i++) {
        hn_strbuf_printf(b, "<dt>%s</dt><dd>%s</dd>", hn_energy_item_words((hn_energy_item)i)->name,
                         hn_energy_item_words((hn_energy_item)i)->about);
    }
    hn_strbuf_add(b, "</dl><p class=\"quiet\">Some integrators solve the constraint equations "
                     "themselves, as in ggl@radau5: there truncation is the error of formulation "
                     "and integrator together. \xe2\x80\x93: not known.</p>");
}

void hn_budgets_html(hn_strbuf *b, const hn_budgets *a) {
    static const char *const heads[] = {"Where the error at the end comes from",
                                        "Causes that put energy in, or took it out"};

    // the head of the page
    const hn_scene *scene = hn_model_scene(a->model);
    char title[300];
    snprintf(title, sizeof title, "%.250s: errors and energy",
             scene->title ? scene->title : scene->id);
    hn_page_head(b, title, hn_style_budget);

    // the heading, and what was compared with what
    hn_strbuf_add(b, "<h1>");
    hn_html_text(b, title);
    hn_strbuf_printf(b,
                     "</h1><p class=\"quiet\">Each method runs from the scene's start to t = %g s. "
                     "Each of its steps is compared with the exact solution of its own equations, "
                     "and with that of the equations of motion.</p>",
                     a->request.time);

    // methods without a budget, with the reason
    put_reasons(b, a);

    // the two budgets: plot above table
    for (int energy = 0; energy < 2; energy++) {
        if (!hn_budgets_can_plot(a->rows, a->n, energy)) {
            continue;
        }
        hn_strbuf_printf(b, "<h2>%s</h2>", heads[energy]);
        hn_page_scroll(b, energy ? "picture of energy" : "picture of the error");
        hn_budgets_plot(b, a->model, a->rows, a->n, energy);
        hn_strbuf_add(b, "</div>");
        put_table(b, a, energy);
    }

    // what the columns mean
    put_legend(b);
    hn_strbuf_add(b, "</main></body></html>\n");
}
