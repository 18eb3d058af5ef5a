// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/cost_plot.h"

#include "render/look.h"

#include <math.h>
#include <stdio.h>

enum { PLOT_ROWS = 21, MOST_COLUMNS = 110 };

bool hn_cost_plot_has_times(const hn_wp *wp) {
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            if (wp->methods[m].point[k].n_samples > 0) {
                return true;
            }
        }
    }
    return false;
}

/// No error below ten times the reference's own is claimed, none above all is told apart.
static double plotted_error(const hn_wp *wp, const hn_wp_point *p) {
    const double bound = HN_WP_ABOVE_REFERENCE * wp->ref->error[HN_ERROR_Q];
    return fmin(1, fmax(fmax(p->worst[HN_ERROR_Q], bound), 1e-16));
}

static void take_point(hn_cost_plot *p, const hn_wp *wp, int m, int k) {
    const hn_wp_point *point = &wp->methods[m].point[k];
    hn_scatter_series *s = &p->scatter.series[m];
    const double cost = hn_wp_cost(point, p->by_time ? HN_COST_TIME : HN_COST_OPS);
    const bool failed = point->state == HN_WP_FAILED && point->first_cpu > 0;
    p->done[m] += point->state == HN_WP_DONE;
    p->failed[m] += point->state == HN_WP_FAILED;

    // where a run ended is on the upper edge, at its cost until then
    if (point->state == HN_WP_DONE && cost > 0) {
        s->point[s->n++] = (hn_scatter_point){.x = cost, .y = plotted_error(wp, point)};
    } else if (failed) {
        s->point[s->n++] = (hn_scatter_point){.x = p->by_time ? point->first_cpu : point->cost.ops,
                                              .on_edge = true};
    }
}

void hn_cost_plot_take(hn_cost_plot *p, const hn_wp *wp, bool by_time) {
    _Static_assert((int)HN_SCATTER_SERIES >= (int)HN_WP_METHODS &&
                       (int)HN_SCATTER_POINTS >= (int)HN_WP_LEVELS,
                   "every point of a study has room");
    *p = (hn_cost_plot){.by_time = by_time, .levels = wp->n_levels};
    p->scatter.n = wp->n_methods;
    p->scatter.y_high = 1;
    p->scatter.x_unit = p->by_time ? "s" : "";
    p->scatter.x_name = p->by_time ? "CPU time" : "operations";
    for (int m = 0; m < wp->n_methods; m++) {
        const int slot = hn_look_slot(m);
        p->scatter.series[m].colour = slot;
        p->scatter.series[m].glyph = hn_look_glyph(m);
        snprintf(p->name[m], sizeof p->name[m], "%s", wp->methods[m].spelling);
        for (int k = 0; k < wp->n_levels; k++) {
            take_point(p, wp, m, k);
        }
    }
}

const char *hn_cost_plot_title(const hn_cost_plot *p) {
    return p->by_time ? "error of the coordinates over CPU time (log, error without unit; ╳: ended)"
                      : "error of the coordinates over operations (log, no units; ╳: ended)";
}

bool hn_cost_plot_draw(hn_cells *c, hn_area area, const hn_cost_plot *p, hn_dot_form form) {
    return hn_scatter_draw(c, area, &p->scatter, form);
}

void hn_cost_plot_text(hn_strbuf *b, const hn_cost_plot *p, int columns, bool legend,
                       bool colours) {
    hn_cells cells = {0};
    const int wide = columns < MOST_COLUMNS ? columns : MOST_COLUMNS;
    const int rows = 1 + PLOT_ROWS + (legend ? p->scatter.n : 0);
    if (!hn_cells_resize(&cells, wide, rows)) {
        hn_strbuf_add(b, "no memory for the plot\n");
        return;
    }

    // a title, the plot, then a line a method
    const hn_area page = {0, 0, wide, rows};
    hn_cells_put(&cells, page, 0, 0, HN_CELL_INK, HN_CELL_BOLD, hn_cost_plot_title(p));
    if (hn_cost_plot_draw(&cells, (hn_area){0, 1, wide, PLOT_ROWS}, p, HN_DOTS_BRAILLE)) {
        for (int m = 0; legend && m < p->scatter.n; m++) {
            const int y = 1 + PLOT_ROWS + m;
            hn_cells_put(&cells, page, 2, y, p->scatter.series[m].colour, HN_CELL_BOLD,
                         p->scatter.series[m].glyph);
            hn_cells_put(&cells, page, 4, y, HN_CELL_INK, 0, p->name[m]);
        }
        hn_cells_text(b, &cells, colours);
    }
    hn_cells_free(&cells);
}
