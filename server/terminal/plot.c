// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/plot.h"

#include "terminal/decades.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_COLUMNS = 8, LEAST_COLUMNS = LABEL_COLUMNS + 8, LEAST_ROWS = 4, ACROSS = 2, DOWN = 4 };

typedef struct range {
    double low, high;
    double step; ///< between two labels
} range;

/// The height of a value in the units of the axis: its logarithm, or itself; NaN where it cannot be
/// shown.
static double height_of(const hn_plot *plot, double y) {
    return plot->logarithmic ? log10(fmax(fabs(y), plot->floor)) : y;
}

static range find_range(const hn_plot *plot) {
    range r = {(double)INFINITY, -(double)INFINITY, 0};
    if (plot->low < plot->high) {
        return (range){height_of(plot, plot->low), height_of(plot, plot->high), 0};
    }
    for (int s = 0; s < plot->n; s++) {
        for (int k = 0; k < plot->series[s].n; k++) {
            const double h = height_of(plot, plot->series[s].y[k]);
            if (isfinite(plot->series[s].y[k])) {
                r.low = fmin(r.low, h);
                r.high = fmax(r.high, h);
            }
        }
    }

    // nothing to show yet: an axis all the same
    if (!(r.low <= r.high)) {
        return plot->logarithmic ? (range){log10(plot->floor), 0, 0} : (range){-1, 1, 0};
    }
    if (plot->logarithmic) {
        // from a whole decade down, over two of them at least
        r.high = fmax(ceil(r.high), floor(r.low) + 2);
    } else if (r.high - r.low < 1e-12 * (fabs(r.high) + fabs(r.low)) || r.high == r.low) {
        const double room = r.high == 0 ? 1 : fabs(r.high) * 0.1;
        r.low -= room;
        r.high += room;
    }
    return r;
}

static void label_of(const hn_plot *plot, double height, char *out, size_t size) {
    if (plot->logarithmic) {
        snprintf(out, size, "1e%+03ld", lround(height));
    } else {
        snprintf(out, size, "%.3g", height);
    }
}

static int row_of(double height, range r, int rows) {
    return (int)lround((r.high - height) / (r.high - r.low) * (rows - 1));
}

/// The axis of time: its ends, and labels between them.
static void draw_time(hn_cells *c, hn_area area, const hn_plot *plot) {
    char end[32];
    const int columns = snprintf(end, sizeof end, "%.4g s", plot->t_end);
    const int inner = area.columns - LABEL_COLUMNS;
    hn_cells_put(c, area, LABEL_COLUMNS, area.rows - 1, HN_CELL_MUTED, 0, "0");
    for (int k = 1; k < plot->intervals; k++) {
        char label[32];
        const int n = snprintf(label, sizeof label, "%.3g", plot->t_end * k / plot->intervals);
        const int at = (int)lround((double)k / plot->intervals * (inner - 1));
        hn_cells_put(c, area, LABEL_COLUMNS + at - n / 2, area.rows - 1, HN_CELL_MUTED, 0, label);
    }
    hn_cells_put(c, area, area.columns - columns, area.rows - 1, HN_CELL_MUTED, 0, end);
}

/// Every decade has a label, or every second, third ... one; other axes have four or five.
static void choose_labels(const hn_plot *plot, int rows, range *r) {
    const int most = rows / 2 > 2 ? rows / 2 : 2;
    if (plot->logarithmic) {
        r->step = hn_decades_spread(r->high, &r->low, rows);
    } else {
        r->step = (r->high - r->low) / (most > 4 ? 4 : most);
    }
}

static void draw_axes(hn_cells *c, hn_area area, hn_area inner, const hn_plot *plot, range r) {
    const double span = r.high - r.low;
    for (double h = r.high; h >= r.low - 1e-9 * span; h -= r.step) {
        char label[HN_PLOT_LABEL * 2];
        label_of(plot, fabs(h) < 1e-9 * span ? 0 : h, label, sizeof label);
        const int row = row_of(h, r, inner.rows);
        hn_cells_printf(c, area, 0, row, HN_CELL_MUTED, 0, "%*s", LABEL_COLUMNS - 1, label);
        hn_cells_put(c, area, LABEL_COLUMNS - 1, row, HN_CELL_MUTED, 0, "┤");
    }
    draw_time(c, area, plot);
    if (plot->unit && plot->unit[0]) {
        hn_cells_printf(c, area, 0, area.rows - 1, HN_CELL_MUTED, 0, "[%s]", plot->unit);
    }
}

static void draw_series(hn_dots *d, const hn_plot *plot, const hn_series *s, range r) {
    const double width = d->columns * ACROSS - 1, tall = d->rows * DOWN - 1;
    double x0 = (double)NAN, y0 = (double)NAN;
    for (int k = 0; k < s->n; k++) {
        const double x = k * plot->dt / plot->t_end * width;
        const double h = height_of(plot, s->y[k]);
        const double y = isfinite(s->y[k]) ? (r.high - h) / (r.high - r.low) * tall : (double)NAN;
        if (isnan(x0) || isnan(y)) {
            hn_dots_line(d, x, y, x, y, s->colour, 1, 0);
        } else {
            hn_dots_line(d, x0, y0, x, y, s->colour, s->on, s->off);
        }
        x0 = x;
        y0 = y;
    }
}

/// The method's glyph where its line ends, so that lines are told apart without colour.
static void mark_end(hn_cells *c, hn_area inner, const hn_plot *plot, const hn_series *s, range r) {
    int last = s->n - 1;
    while (last >= 0 && !isfinite(s->y[last])) {
        last--;
    }
    if (last < 0) {
        return;
    }
    const double share = last * plot->dt / plot->t_end;
    int x = (int)lround(share * (inner.columns - 1));
    const int y = row_of(height_of(plot, s->y[last]), r, inner.rows);
    // lines that end together stand side by side
    while (x > 0 && c->at[(inner.y + y) * c->columns + inner.x + x].glyph[0]) {
        x--;
    }
    hn_cells_put(c, inner, x, y, s->colour, HN_CELL_BOLD, s->glyph);
}

void hn_plot_draw(hn_cells *c, hn_area area, const hn_plot *plot, hn_dot_form form) {
    if (area.columns < LEAST_COLUMNS || area.rows < LEAST_ROWS || !(plot->t_end > 0)) {
        return;
    }
    const hn_area inner = {area.x + LABEL_COLUMNS, area.y, area.columns - LABEL_COLUMNS,
                           area.rows - 1};
    range r = find_range(plot);
    hn_dots dots = {0};
    choose_labels(plot, inner.rows, &r);
    draw_axes(c, area, inner, plot, r);
    if (!hn_dots_resize(&dots, inner.columns, inner.rows)) {
        return;
    }

    // glyphs first: dots leave them room
    for (int s = 0; s < plot->n; s++) {
        mark_end(c, inner, plot, &plot->series[s], r);
        draw_series(&dots, plot, &plot->series[s], r);
    }
    if (isfinite(plot->cursor)) {
        const double x = plot->cursor / plot->t_end * (inner.columns * ACROSS - 1);
        hn_dots_line(&dots, x, 0, x, inner.rows * DOWN, HN_CELL_MUTED, 1, 3);
    }
    hn_dots_show(c, inner, &dots, form);
    hn_dots_free(&dots);
}
