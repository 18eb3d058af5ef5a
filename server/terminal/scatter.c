// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/scatter.h"

#include "base/units.h"
#include "terminal/decades.h"

#include <math.h>
#include <string.h>

enum {
    LABEL_COLUMNS = 8,
    LEAST_COLUMNS = LABEL_COLUMNS + 12,
    LEAST_ROWS = 5,
    ACROSS = 2,
    DOWN = 4
};

/// A point that is on the upper edge only: a large cross.
static const char EDGE_MARK[] = "╳";

/// Powers of ten; whole decades for the vertical axis.
typedef struct range {
    double left, right, low, high;
} range;

static bool find_range(const hn_scatter *s, range *r) {
    *r = (range){HUGE_VAL, -HUGE_VAL, HUGE_VAL, log10(s->y_high)};
    for (int i = 0; i < s->n; i++) {
        for (int k = 0; k < s->series[i].n; k++) {
            const hn_scatter_point *p = &s->series[i].point[k];
            if (!p->on_edge) {
                r->left = fmin(r->left, log10(p->x));
                r->right = fmax(r->right, log10(p->x));
                r->low = fmin(r->low, floor(log10(p->y)));
            }
        }
    }
    const double margin = 0.03 * (r->right - r->left) + 0.02;
    r->left -= margin;
    r->right += margin;
    return r->right > r->left && r->low < r->high;
}

/// The share of the width or height, 0 to 1 from the left and from the top.
static double across(const range *r, double x) {
    return x > 0 ? fmin(1, fmax(0, (log10(x) - r->left) / (r->right - r->left))) : 0;
}

static double down(const range *r, const hn_scatter_point *p) {
    return p->on_edge ? 0 : fmin(1, fmax(0, (r->high - log10(p->y)) / (r->high - r->low)));
}

static void draw_axes(hn_cells *c, hn_area area, hn_area inner, const hn_scatter *s, range r,
                      double step) {
    for (double h = r.high; h >= r.low - 1e-9; h -= step) {
        const int row = (int)lround((r.high - h) / (r.high - r.low) * (inner.rows - 1));
        hn_cells_printf(c, area, 0, row, HN_CELL_MUTED, 0, "  1e%+03ld┤", lround(h));
    }

    // what stands above, and the ends of the horizontal axis
    char text[HN_SI_TEXT];
    const int foot = area.rows - 1;
    hn_si_format(hn_round_digits(pow(10, r.left), 2), s->x_unit, 2, text);
    hn_cells_put(c, area, LABEL_COLUMNS, foot, HN_CELL_MUTED, 0, text);
    hn_si_format(hn_round_digits(pow(10, r.right), 2), s->x_unit, 2, text);
    hn_cells_put(c, area, area.columns - hn_text_columns(text), foot, HN_CELL_MUTED, 0, text);
    const char *name = s->x_name ? s->x_name : "";
    const int middle = LABEL_COLUMNS + (inner.columns - hn_text_columns(name)) / 2;
    hn_cells_put(c, area, middle, foot, HN_CELL_MUTED, 0, name);
}

/// The first glyph in a cell stays.
static void draw_series(hn_cells *c, hn_area inner, hn_dots *d, const hn_scatter_series *s,
                        const range *r) {
    double x0 = (double)NAN, y0 = (double)NAN;
    for (int k = 0; k < s->n; k++) {
        const hn_scatter_point *p = &s->point[k];
        const double x = across(r, p->x), y = down(r, p);
        const int column = (int)lround(x * (inner.columns - 1));
        const int row = (int)lround(y * (inner.rows - 1));
        if (!c->at[(inner.y + row) * c->columns + inner.x + column].glyph[0]) {
            hn_cells_put(c, inner, column, row, p->on_edge ? HN_CELL_ALARM : s->colour,
                         HN_CELL_BOLD, p->on_edge ? EDGE_MARK : s->glyph);
        }

        // a line to the point before it, where both have a height
        if (!p->on_edge) {
            const double right = d->columns * ACROSS - 1, bottom = d->rows * DOWN - 1;
            hn_dots_line(d, x0 * right, y0 * bottom, x * right, y * bottom, s->colour, 1, 0);
            x0 = x;
            y0 = y;
        }
    }
}

bool hn_scatter_draw(hn_cells *c, hn_area area, const hn_scatter *s, hn_dot_form form) {
    const hn_area inner = {area.x + LABEL_COLUMNS, area.y, area.columns - LABEL_COLUMNS,
                           area.rows - 1};
    const bool inside = area.x + area.columns <= c->columns && area.y + area.rows <= c->rows;
    hn_dots dots = {0};
    range r;
    if (area.columns < LEAST_COLUMNS || area.rows < LEAST_ROWS || !inside || !find_range(s, &r) ||
        !hn_dots_resize(&dots, inner.columns, inner.rows)) {
        return false;
    }

    // glyphs first: dots leave them room
    const double step = hn_decades_spread(r.high, &r.low, inner.rows);
    draw_axes(c, area, inner, s, r, step);
    for (int i = 0; i < s->n; i++) {
        draw_series(c, inner, &dots, &s->series[i], &r);
    }
    hn_dots_show(c, inner, &dots, form);
    hn_dots_free(&dots);
    return true;
}
