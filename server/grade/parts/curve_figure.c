// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/curve_figure.h"

#include "render/canvas_svg.h"
#include "terminal/plot.h"

#include <math.h>
#include <stdio.h>

enum {
    ROWS = 17,
    INTERVALS = 5,
    WIDTH = 640,
    HEIGHT = 300,
    LEFT = 64,
    RIGHT = 16,
    TOP = 34,
    BOTTOM = 44
};

void hn_curve_axis(const hn_motion_curve *c, double *low, double *high) {
    static const double STEPS[] = {1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
    const double span = fmax(c->high - c->low, fmax(1e-12, 1e-9 * fabs(c->high)));
    const double bottom = c->low >= 0 ? fmax(c->low - 0.02 * span, 0) : c->low - 0.02 * span;
    const double top = c->high + 0.02 * span, power = pow(10, floor(log10((top - bottom) / 4)));

    // the least round step whose four intervals hold the values; twice the last holds any
    for (int i = 0; i < 20; i++) {
        const double step = power * (i < 10 ? STEPS[i] : 10 * STEPS[i - 10]);
        *low = step * floor(bottom / step);
        *high = *low + 4 * step;
        if (*high >= top) {
            return;
        }
    }
}

void hn_curve_text(hn_strbuf *b, const hn_motion_curve *c, const char *title, int columns) {
    hn_cells cells = {0};
    if (!hn_cells_resize(&cells, columns, ROWS)) {
        b->failed = 1;
        return;
    }
    hn_plot plot = {.dt = c->dt,
                    .t_end = c->t_end,
                    .cursor = (double)NAN,
                    .unit = c->unit,
                    .intervals = INTERVALS,
                    .n = 1};
    hn_curve_axis(c, &plot.low, &plot.high);
    plot.series[0] = (hn_series){.y = c->y, .n = c->n, .glyph = "", .on = 1};
    hn_cells_put(&cells, (hn_area){0, 0, columns, 1}, 0, 0, HN_CELL_INK, HN_CELL_PLAIN, title);
    hn_plot_draw(&cells, (hn_area){0, 1, columns, ROWS - 1}, &plot, HN_DOTS_BRAILLE);
    hn_cells_text(b, &cells, false);
    hn_cells_free(&cells);
}

static double across(const hn_motion_curve *c, double t) {
    return LEFT + t / c->t_end * (WIDTH - LEFT - RIGHT);
}

static double down(double y, double low, double high) {
    return TOP + (high - y) / (high - low) * (HEIGHT - TOP - BOTTOM);
}

static void put_grid(hn_strbuf *b, const hn_motion_curve *c, double low, double high) {
    for (int k = 0; k <= 4; k++) {
        const double level = low + (high - low) * k / 4, y = down(level, low, high);
        const double value = fabs(level) < 1e-9 * (high - low) ? 0 : level;
        hn_strbuf_printf(b,
                         "<path class=\"grid\" d=\"M%d %.1fH%d\"/><text x=\"%d\" y=\"%.1f\" "
                         "text-anchor=\"end\">%.4g</text>\n",
                         LEFT, y, WIDTH - RIGHT, LEFT - 6, y + 4, value);
    }
    for (int k = 0; k <= INTERVALS; k++) {
        const double t = c->t_end * k / INTERVALS, x = across(c, t);
        hn_strbuf_printf(b,
                         "<path class=\"grid\" d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\" "
                         "text-anchor=\"middle\">%.4g</text>\n",
                         x, TOP, HEIGHT - BOTTOM, x, HEIGHT - BOTTOM + 18, t);
    }
}

/// Without a style of the page it has ink and paper.
void hn_curve_svg(hn_strbuf *b, const hn_motion_curve *c, const char *title) {
    double low, high;
    hn_curve_axis(c, &low, &high);
    hn_strbuf_printf(b,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" "
                     "role=\"img\"><title>%s</title><style>svg{color:#1a1d21}"
                     ".paper{fill:#fcfcfa}text{font:13px sans-serif;"
                     "fill:currentColor}path{fill:none;stroke:currentColor}.grid{opacity:.25}"
                     ".curve{stroke-width:2}</style>\n"
                     "<rect class=\"paper\" fill=\"none\" width=\"%d\" height=\"%d\"/>\n",
                     WIDTH, HEIGHT, title, WIDTH, HEIGHT);
    hn_strbuf_printf(b, "<text x=\"%d\" y=\"18\">%s</text>\n", LEFT, title);
    put_grid(b, c, low, high);
    hn_strbuf_printf(b, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">t [s]</text>\n", WIDTH - RIGHT,
                     HEIGHT - 6);

    // the curve, a point a sample
    hn_strbuf_add(b, "<path class=\"curve\" d=\"");
    for (int k = 0; k < c->n; k++) {
        hn_strbuf_printf(b, "%s%.1f %.1f", k ? "L" : "M", across(c, k * c->dt),
                         down(c->y[k], low, high));
    }
    hn_strbuf_add(b, "\"/></svg>\n");
}

// ---- as a file ----

static const double LETTERS = 14, SMALL = 12; // [px]

static void write_number(hn_canvas *c, double x, double y, hn_align align, double value) {
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    hn_canvas_text(c, x, y, SMALL, align, hn_paint_solid(hn_surface_get(HN_THEME_LIGHT)->ink),
                   text);
}

static void draw_grid(hn_canvas *c, const hn_motion_curve *curve, double low, double high) {
    const hn_stroke line = hn_stroke_solid(hn_surface_get(HN_THEME_LIGHT)->hairline, 1);
    for (int k = 0; k <= 4; k++) {
        const double level = low + (high - low) * k / 4, y = down(level, low, high);
        hn_canvas_segment(c, LEFT, y, WIDTH - RIGHT, y, &line);
        write_number(c, LEFT - 6, y + 4, HN_ALIGN_RIGHT,
                     fabs(level) < 1e-9 * (high - low) ? 0 : level);
    }
    for (int k = 0; k <= INTERVALS; k++) {
        const double t = curve->t_end * k / INTERVALS, x = across(curve, t);
        hn_canvas_segment(c, x, TOP, x, HEIGHT - BOTTOM, &line);
        write_number(c, x, HEIGHT - BOTTOM + 17, HN_ALIGN_CENTRE, t);
    }
}

static void draw_curve(hn_canvas *c, const hn_motion_curve *curve, const char *title) {
    const hn_surface *surface = hn_surface_get(HN_THEME_LIGHT);
    const hn_stroke line = hn_stroke_solid(hn_look_get(0)->colour[HN_THEME_LIGHT], 2);
    double low, high, xy[2 * HN_CURVE_POINTS];
    char text[96];
    hn_curve_axis(curve, &low, &high);
    hn_canvas_text(c, LEFT, 20, LETTERS, HN_ALIGN_LEFT, hn_paint_solid(surface->ink), title);
    draw_grid(c, curve, low, high);
    for (int k = 0; k < curve->n; k++) {
        xy[2 * k] = across(curve, k * curve->dt);
        xy[2 * k + 1] = down(curve->y[k], low, high);
    }
    hn_canvas_line(c, xy, curve->n, &line);
    snprintf(text, sizeof text, "%d samples, %.3g s apart", curve->n, curve->dt);
    hn_canvas_text(c, LEFT, HEIGHT - 6, SMALL, HN_ALIGN_LEFT, hn_paint_solid(surface->muted), text);
    hn_canvas_text(c, WIDTH - RIGHT, HEIGHT - 6, SMALL, HN_ALIGN_RIGHT,
                   hn_paint_solid(surface->ink), "t [s]");
}

void hn_curve_picture(hn_strbuf *b, const hn_motion_curve *c, const char *title) {
    hn_canvas *canvas = NULL;
    hn_status status = hn_canvas_create(WIDTH, HEIGHT, HN_THEME_LIGHT, &canvas, NULL);
    if (status == HN_OK) {
        draw_curve(canvas, c, title);
        status = hn_canvas_svg(b, &canvas, 1, 1, title, NULL, NULL);
    }
    b->failed |= status != HN_OK;
    hn_canvas_free(canvas);
}
