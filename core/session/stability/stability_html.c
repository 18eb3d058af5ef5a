// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_html.h"

#include "session/precision/study_html.h"
#include "session/precision/study_page.h"
#include "session/stability/stability_column.h"
#include "session/stability/stability_frame.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static void put_class_colours(hn_strbuf *b, hn_theme theme) {
    for (int k = 0; k < HN_STABILITY_CLASS_COUNT; k++) {
        hn_strbuf_printf(b, "--%s:#%06X;", hn_stability_class_name((hn_stability_class)k),
                         (unsigned)hn_map_class_colour((hn_stability_class)k, theme));
    }
}

enum {
    ABOVE = 8,
    BELOW = 46
}; // room [px] above and below a field on a page, for the frame and the labels of the axis

// Writes the style rules of the picture; the SVG file on its own needs them too.
static void put_rules(hn_strbuf *b) {
    hn_strbuf_add(b, "text{fill:var(--ink);font:12px system-ui,sans-serif}.quiet-text{fill:var(--"
                     "muted)}.end{text-anchor:end}.middle{text-anchor:middle}.glyph{font-size:9px}"
                     ".head{font-size:14px;font-weight:600}.said{font-size:12px}"
                     ".predicted{fill:none;stroke:var(--ink);stroke-width:2.5}"
                     ".observed{fill:none;stroke:var(--ink);stroke-width:1.5;stroke-dasharray:2 3}"
                     ".frame{fill:none;stroke:var(--muted)}");
    for (int k = 0; k < HN_STABILITY_CLASS_COUNT; k++) {
        const char *name = hn_stability_class_name((hn_stability_class)k);
        hn_strbuf_printf(b, ".c-%s{fill:var(--%s);fill-opacity:%g}", name, name,
                         hn_map_class_look_get((hn_stability_class)k)->opacity);
    }
}

static void put_cell(hn_strbuf *b, const hn_map *map, int m, int i, int j) {
    const hn_stability_class kind = hn_map_get(map, m, i, j)->trial.kind;
    const double x = hn_map_column_edge(map, i), w = hn_map_column_edge(map, i + 1) - x;
    const double y = hn_map_row_edge(map, m, j + 1), h = hn_map_row_edge(map, m, j) - y;

    // the outcome in words, shown on pointing
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_map_cell_text(&text, map, m, i, j);
    hn_strbuf_printf(b, "<g><title>");
    hn_html_text(b, hn_strbuf_text(&text));

    // the cell itself, coloured by its class
    hn_strbuf_printf(b,
                     "</title><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                     "class=\"c-%s\"/>",
                     x, y, w, h, hn_stability_class_name(kind));

    // the sign of the class, where the cell has room for it
    const char *glyph = hn_map_class_look_get(kind)->glyph;
    if (glyph[0] && w >= 8 && h >= 8) {
        hn_strbuf_printf(b, "<text x=\"%.2f\" y=\"%.2f\" class=\"glyph middle\">%s</text>",
                         x + w / 2, y + h / 2 + 3, glyph);
    }

    hn_strbuf_add(b, "</g>\n");
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

static bool is_inside(double y, int m) {
    return y >= hn_map_field_top(m) && y <= hn_map_field_top(m) + HN_MAP_FIELD_HEIGHT;
}

// Draws the predicted limit: a stroke across each column, joined to that of the next column.
static void put_predicted(hn_strbuf *b, const hn_map *map, int m) {
    hn_strbuf_add(b, "<path class=\"predicted\" d=\"");
    for (int k = 0; k < HN_MAP_CROSSINGS; k++) {
        int joined = 0;
        for (int i = 0; i < hn_map_x(map)->n; i++) {
            const hn_map_column *c = hn_map_get_column(map, m, i);
            const double y =
                k < c->n_predicted ? hn_map_height_of(map, m, c->predicted[k]) : (double)NAN;
            const int there = k < c->n_predicted && is_inside(y, m);
            if (there) {
                const double x0 = hn_map_column_edge(map, i), x1 = hn_map_column_edge(map, i + 1);
                hn_strbuf_printf(b, "%c%.2f %.2fH%.2f", joined ? 'L' : 'M',
                                 joined ? (x0 + x1) / 2 : x0, y, x1);
            }
            joined = there;
        }
    }
    hn_strbuf_add(b, "\"/>\n");
}

// Draws strokes across rows where the boundary is steep.
static void put_steep(hn_strbuf *b, const hn_map *map, int m) {
    hn_strbuf_add(b, "<path class=\"predicted\" d=\"");
    for (int j = 0; j < hn_map_y(map)->n; j++) {
        for (int i = 0; i < hn_map_x(map)->n; i++) {
            double x;
            if (hn_map_crossing_x(map, m, i, j, &x)) {
                hn_strbuf_printf(b, "M%.2f %.2fV%.2f", x, hn_map_row_edge(map, m, j),
                                 hn_map_row_edge(map, m, j + 1));
            }
        }
    }
    hn_strbuf_add(b, "\"/>\n");
}

static void put_observed(hn_strbuf *b, const hn_map *map, int m) {
    hn_strbuf_add(b, "<path class=\"observed\" d=\"");
    for (int i = 0; hn_map_y(map)->is_step && i < hn_map_x(map)->n; i++) {
        const hn_map_column *c = hn_map_get_column(map, m, i);
        const double y =
            c->stable > 0 ? hn_map_height_of(map, m, sqrt(c->stable * c->unstable)) : (double)NAN;
        if (c->stable > 0 && is_inside(y, m)) {
            hn_strbuf_printf(b, "M%.2f %.2fH%.2f", hn_map_column_edge(map, i), y,
                             hn_map_column_edge(map, i + 1));
        }
    }
    hn_strbuf_add(b, "\"/>\n");
}

static void put_axes(hn_strbuf *b, const hn_map *map, int m) {
    const hn_map_axis *x = hn_map_x(map), *y = hn_map_y(map);
    const double top = hn_map_field_top(m), bottom = top + HN_MAP_FIELD_HEIGHT;
    int at[8];
    char title[96];

    // the frame
    hn_strbuf_printf(b, "<rect class=\"frame\" x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%d\"/>",
                     HN_MAP_LEFT, top, HN_MAP_FIELD_WIDTH, HN_MAP_FIELD_HEIGHT);

    // ticks of the vertical axis
    for (int k = 0, n = hn_map_ticks(y, at); k < n; k++) {
        const double here =
            (hn_map_row_edge(map, m, at[k]) + hn_map_row_edge(map, m, at[k] + 1)) / 2;
        hn_strbuf_printf(b, "<text x=\"%d\" y=\"%.1f\" class=\"end quiet-text\">%.3g</text>",
                         HN_MAP_LEFT - 8, here + 4, y->value[at[k]]);
    }

    // ticks of the horizontal axis, where there is one
    for (int k = 0, n = x->name[0] ? hn_map_ticks(x, at) : 0; k < n; k++) {
        const double here =
            (hn_map_column_edge(map, at[k]) + hn_map_column_edge(map, at[k] + 1)) / 2;
        hn_strbuf_printf(b, "<text x=\"%.1f\" y=\"%.1f\" class=\"middle quiet-text\">%.3g</text>",
                         here, bottom + 16, x->value[at[k]]);
    }

    // both titles, the vertical one turned
    hn_map_axis_title(x, title);
    hn_strbuf_printf(b, "<text x=\"%d\" y=\"%.1f\" class=\"middle\">",
                     HN_MAP_LEFT + HN_MAP_FIELD_WIDTH / 2, bottom + 34);
    hn_html_text(b, title);
    hn_map_axis_title(y, title);
    hn_strbuf_printf(b,
                     "</text><text transform=\"translate(18 %.1f) rotate(-90)\" class=\"middle\">",
                     (top + bottom) / 2);
    hn_html_text(b, title);
    hn_strbuf_add(b, "</text>\n");
}

static void put_legend(hn_strbuf *b, int m) {
    const double x = HN_MAP_LEFT + HN_MAP_FIELD_WIDTH + 24;
    double y = hn_map_field_top(m) + 10;
    for (int k = HN_STABILITY_FINE; k < HN_STABILITY_CLASS_COUNT; k++, y += 22) {
        const hn_map_class_look *look = hn_map_class_look_get((hn_stability_class)k);
        hn_strbuf_printf(
            b,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"14\" class=\"c-%s\"/><text "
            "x=\"%.1f\" y=\"%.1f\" class=\"glyph middle\">%s</text><text x=\"%.1f\" y=\"%.1f\">%s"
            "</text>\n",
            x, y, hn_stability_class_name(look->kind), x + 7, y + 10, look->glyph, x + 22, y + 11,
            look->words);
    }
    hn_strbuf_printf(b,
                     "<path class=\"predicted\" d=\"M%.1f %.1fh14\"/><text x=\"%.1f\" "
                     "y=\"%.1f\">predicted from the spectrum</text>"
                     "<path class=\"observed\" d=\"M%.1f %.1fh14\"/><text x=\"%.1f\" "
                     "y=\"%.1f\">observed, to 2 %%</text>\n",
                     x, y + 8, x + 22, y + 12, x, y + 30, x + 22, y + 34);
}

static void put_agreement(hn_strbuf *b, const hn_map *map, int m) {
    hn_strbuf said;
    hn_strbuf_init(&said);
    hn_map_agreement_text(&said, map, m);
    hn_html_text(b, hn_strbuf_text(&said));
    b->failed |= said.failed;
    hn_strbuf_reset(&said);
}

/// Draws the field of one method with its axes and legend.
static void put_map(hn_strbuf *b, const hn_map *map, int m) {
    for (int j = 0; j < hn_map_y(map)->n; j++) {
        for (int i = 0; i < hn_map_x(map)->n; i++) {
            put_cell(b, map, m, i, j);
        }
    }
    put_predicted(b, map, m);
    put_steep(b, map, m);
    put_observed(b, map, m);
    put_axes(b, map, m);
    put_legend(b, m);
}

static void put_heading(hn_strbuf *b, const hn_map *map, int m) {
    hn_map_said_line said[HN_MAP_SAID_LINES];
    const int n = hn_map_said(map, m, said);
    double y = hn_map_field_top(m) - 12 - HN_MAP_SAID_HEIGHT * (n - 1);
    hn_strbuf_printf(b, "\n<text x=\"%d\" y=\"%.1f\" class=\"head\">", HN_MAP_LEFT, y - 18);
    hn_html_text(b, hn_map_method(map, m));
    hn_strbuf_add(b, "</text>");
    for (int i = 0; i < n; i++, y += HN_MAP_SAID_HEIGHT) {
        hn_strbuf_printf(b, "<text x=\"%d\" y=\"%.1f\" class=\"said quiet-text\">", HN_MAP_LEFT, y);
        hn_html_text(b, said[i]);
        hn_strbuf_add(b, "</text>");
    }
    hn_strbuf_add(b, "\n");
}

void hn_map_svg(hn_strbuf *b, const hn_map *map) {
    hn_strbuf_printf(b,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
                     "aria-label=\"where steps are stable, a map a method\"><style>svg{",
                     HN_MAP_WIDTH, hn_map_height(map));
    hn_page_theme(b, HN_THEME_LIGHT);
    put_class_colours(b, HN_THEME_LIGHT);
    hn_strbuf_add(b, "background:var(--paper)}");
    put_rules(b);
    hn_strbuf_add(b, "</style>");
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        put_heading(b, map, m);
        put_map(b, map, m);
    }
    hn_strbuf_add(b, "</svg>\n");
}

/// Writes a section for each method, so that text wraps and paper breaks between maps.
static void put_sections(hn_strbuf *b, const hn_map *map) {
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        hn_strbuf_add(b, "<section><h2>");
        hn_html_text(b, hn_map_method(map, m));
        hn_strbuf_add(b, "</h2><p class=\"quiet\">");
        put_agreement(b, map, m);
        hn_strbuf_add(b, "</p>");
        hn_page_scroll(b, "map");
        hn_strbuf_printf(b,
                         "<svg viewBox=\"0 %.1f %d %d\" role=\"img\" aria-label=\"where steps are "
                         "stable: ",
                         hn_map_field_top(m) - ABOVE, HN_MAP_WIDTH,
                         ABOVE + HN_MAP_FIELD_HEIGHT + BELOW);
        hn_html_text(b, hn_map_method(map, m));
        hn_strbuf_add(b, "\">");
        put_map(b, map, m);
        hn_strbuf_add(b, "</svg></div></section>\n");
    }
}

static void put_steps(hn_strbuf *b, const hn_map *map) {
    hn_strbuf said;
    hn_strbuf_init(&said);
    hn_strbuf_add(b, "<h2>Steps</h2><ul>");
    for (int m = 0; m < hn_map_n_methods(hn_map_steps(map)); m++) {
        hn_strbuf_clear(&said);
        hn_map_steps_text(&said, map, m);
        hn_strbuf_add(b, "<li>");
        hn_html_text(b, hn_strbuf_text(&said));
        hn_strbuf_add(b, "</li>");
    }
    hn_strbuf_add(b, "</ul>\n");
    b->failed |= said.failed;
    hn_strbuf_reset(&said);
}

static void put_limits(hn_strbuf *b, const hn_map *map) {
    // the head of the table
    hn_strbuf_add(b, "<h2>Boundaries</h2>");
    hn_page_table(b, "Boundaries");
    hn_strbuf_add(b, "<thead><tr><th>method</th>");
    hn_strbuf_printf(b, "<th class=\"n\">%s</th>", hn_map_x(map)->name);
    hn_strbuf_add(b, "<th class=\"n\">step for 1 %% error [s]</th>"
                     "<th class=\"n\">predicted [s]</th><th class=\"n\">last stable [s]</th>"
                     "<th class=\"n\">first unstable [s]</th>"
                     "<th>what happened at the first unstable step</th></tr></thead><tbody>");
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        for (int i = 0; i < hn_map_x(map)->n; i++) {
            const hn_map_column *c = hn_map_get_column(map, m, i);

            // the method and the value of the parameter
            hn_strbuf_add(b, "<tr><th scope=\"row\" class=\"m\">");
            hn_html_text(b, hn_map_method(map, m));
            hn_strbuf_printf(b,
                             hn_map_x(map)->name[0] ? "</th><td class=\"n\">%.4g</td>"
                                                    : "</th><td class=\"n\">–</td>",
                             hn_map_x(map)->value[i]);

            // the largest accurate step, the predicted limit, and the two steps that enclose the
            // measured one
            const double list[] = {c->accurate, c->n_predicted ? c->predicted[0] : (double)NAN,
                                   c->stable, c->unstable};
            for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
                hn_strbuf_printf(
                    b, isfinite(list[k]) ? "<td class=\"n\">%.4g</td>" : "<td class=\"n\">–</td>",
                    list[k]);
            }

            // how the run ended beyond the boundary
            hn_strbuf_add(b, "<td>");
            hn_html_text(b, c->how);
            hn_strbuf_add(b, "</td></tr>\n");
        }
    }
    hn_strbuf_add(b, "</tbody></table></div>");
}

static void put_head(hn_strbuf *b, const char *of) {
    char title[200];
    hn_strbuf style;
    hn_strbuf_init(&style);
    snprintf(title, sizeof title, "%.160s: where steps are stable", of);
    hn_strbuf_add(&style,
                  "main{max-width:980px}section{break-inside:avoid}.scroll>svg{min-width:640px}"
                  "@media print{.scroll>svg{min-width:0;max-height:96mm}}:root{");
    put_class_colours(&style, HN_THEME_LIGHT);
    hn_strbuf_add(&style, "}@media screen and (prefers-color-scheme:dark){:root{");
    put_class_colours(&style, HN_THEME_DARK);
    hn_strbuf_add(&style, "}}");
    put_rules(&style);
    hn_page_head(b, title, hn_strbuf_text(&style));
    b->failed |= style.failed;
    hn_strbuf_reset(&style);
}

void hn_map_html(hn_strbuf *b, const hn_map *map) {
    const hn_scene *scene = hn_model_scene(hn_map_model(map));
    const char *title = scene->title ? scene->title : scene->id;

    // the heading, and how to read the map
    put_head(b, title);
    hn_strbuf_add(b, "<h1>");
    hn_html_text(b, title);
    hn_strbuf_printf(
        b,
        ": where steps are stable</h1><p>Every cell is a run to t = %g s, or of %d steps where "
        "that is longer. The thick line is the limit of the step that is predicted from the "
        "eigenvalues of the motion on the loops: the smallest along the motion. At the dotted line "
        "the errors of runs began to grow, or runs ended. Point at a cell to read its outcome.</p>",
        hn_map_time(map), HN_STABILITY_LEAST_STEPS);

    // where a map of steps has chosen this one, what it found comes first
    const hn_map *steps = hn_map_steps(map);
    if (steps) {
        put_steps(b, map);
    }

    // the maps, and a table of limits where the step size is an axis
    put_sections(b, map);
    if (steps || hn_map_y(map)->is_step) {
        put_limits(b, steps ? steps : map);
    }

    // the terms and thresholds used above
    hn_strbuf_printf(
        b,
        "<h2>What the words mean</h2><p class=\"quiet\">Error: the largest difference of the "
        "velocities from those of a motion computed with small steps, in the energy norm, relative "
        "to the range of the motion's energy. Grew: the energy was above that of the motion by %g "
        "times this range, or by one range and still rising, or the loop was open by %g of the "
        "mechanism's length. Stopped: the run ended with a reason. Implicit integrators have no "
        "limit of this kind; they end where Newton's method no longer "
        "converges.</p></main></body></html>\n",
        HN_STABILITY_RUNAWAY, HN_STABILITY_OPEN);
}
