// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_picture.h"

#include "render/canvas.h"
#include "session/stability/stability_frame.h"

#include <math.h>
#include <stdio.h>

enum { TEXT_SIZE = 13 };

typedef struct drawing {
    hn_canvas *c;
    const hn_map *map;
    const hn_surface *surface;
    hn_paint ink, muted;
} drawing;

static void draw_box(drawing *d, double x0, double y0, double x1, double y1,
                     hn_stability_class kind) {
    const double xy[] = {x0, y0, x1, y0, x1, y1, x0, y1};
    const hn_paint paint = {hn_map_class_colour(kind, HN_THEME_LIGHT),
                            hn_map_class_look_get(kind)->opacity};
    if (paint.alpha > 0) {
        hn_canvas_polygon(d->c, xy, 4, paint);
    }
}

static void draw_sign(drawing *d, double x, double y, hn_stability_class kind) {
    hn_canvas_text(d->c, x, y + 3, 9, HN_ALIGN_CENTRE, d->ink, hn_map_class_look_get(kind)->glyph);
}

static void draw_cells(drawing *d, int m) {
    for (int j = 0; j < hn_map_y(d->map)->n; j++) {
        for (int i = 0; i < hn_map_x(d->map)->n; i++) {
            const hn_stability_class kind = hn_map_get(d->map, m, i, j)->trial.kind;
            const double x0 = hn_map_column_edge(d->map, i), x1 = hn_map_column_edge(d->map, i + 1);
            const double y1 = hn_map_row_edge(d->map, m, j), y0 = hn_map_row_edge(d->map, m, j + 1);
            draw_box(d, x0, y0, x1, y1, kind);
            if (x1 - x0 >= 8 && y1 - y0 >= 8) {
                draw_sign(d, (x0 + x1) / 2, (y0 + y1) / 2, kind);
            }
        }
    }
}

static void draw_level(drawing *d, int m, int i, double value, double width) {
    const hn_stroke stroke = hn_stroke_solid(d->surface->ink, width);
    const double y = hn_map_height_of(d->map, m, value), top = hn_map_field_top(m);
    if (value > 0 && y >= top && y <= top + HN_MAP_FIELD_HEIGHT) {
        hn_canvas_segment(d->c, hn_map_column_edge(d->map, i), y, hn_map_column_edge(d->map, i + 1),
                          y, &stroke);
    }
}

static void draw_boundaries(drawing *d, int m) {
    for (int i = 0; i < hn_map_x(d->map)->n; i++) {
        const hn_map_column *c = hn_map_get_column(d->map, m, i);
        for (int k = 0; k < c->n_predicted; k++) {
            draw_level(d, m, i, c->predicted[k], 2.5);
        }
        if (c->stable > 0) {
            draw_level(d, m, i, sqrt(c->stable * c->unstable), 1);
        }
    }
}

static void draw_steep(drawing *d, int m) {
    const hn_stroke stroke = hn_stroke_solid(d->surface->ink, 2.5);
    for (int j = 0; j < hn_map_y(d->map)->n; j++) {
        for (int i = 0; i < hn_map_x(d->map)->n; i++) {
            double x;
            if (hn_map_crossing_x(d->map, m, i, j, &x)) {
                hn_canvas_segment(d->c, x, hn_map_row_edge(d->map, m, j), x,
                                  hn_map_row_edge(d->map, m, j + 1), &stroke);
            }
        }
    }
}

static void draw_axes(drawing *d, int m) {
    const hn_map_axis *x = hn_map_x(d->map), *y = hn_map_y(d->map);
    const double top = hn_map_field_top(m), bottom = top + HN_MAP_FIELD_HEIGHT;
    int at[8];
    char text[96];

    // ticks of the vertical axis
    for (int k = 0, n = hn_map_ticks(y, at); k < n; k++) {
        const double here =
            (hn_map_row_edge(d->map, m, at[k]) + hn_map_row_edge(d->map, m, at[k] + 1)) / 2;
        snprintf(text, sizeof text, "%.3g", y->value[at[k]]);
        hn_canvas_text(d->c, HN_MAP_LEFT - 8, here + 4, TEXT_SIZE, HN_ALIGN_RIGHT, d->muted, text);
    }

    // ticks of the horizontal axis, where there is one
    for (int k = 0, n = x->name[0] ? hn_map_ticks(x, at) : 0; k < n; k++) {
        const double here =
            (hn_map_column_edge(d->map, at[k]) + hn_map_column_edge(d->map, at[k] + 1)) / 2;
        snprintf(text, sizeof text, "%.3g", x->value[at[k]]);
        hn_canvas_text(d->c, here, bottom + 17, TEXT_SIZE, HN_ALIGN_CENTRE, d->muted, text);
    }

    // both titles
    hn_map_axis_title(x, text);
    hn_canvas_text(d->c, HN_MAP_LEFT + HN_MAP_FIELD_WIDTH / 2.0, bottom + 36, TEXT_SIZE,
                   HN_ALIGN_CENTRE, d->ink, text);
    hn_map_axis_title(y, text);
    hn_canvas_text(d->c, 8, top - 12, TEXT_SIZE, HN_ALIGN_LEFT, d->ink, text);
}

static void draw_legend(drawing *d, int m) {
    const double x = HN_MAP_LEFT + HN_MAP_FIELD_WIDTH + 24;
    double y = hn_map_field_top(m) + 10;
    const hn_stroke thick = hn_stroke_solid(d->surface->ink, 2.5),
                    thin = hn_stroke_solid(d->surface->ink, 1);
    for (int k = HN_STABILITY_FINE; k < HN_STABILITY_CLASS_COUNT; k++, y += 22) {
        const hn_map_class_look *look = hn_map_class_look_get((hn_stability_class)k);
        draw_box(d, x, y, x + 14, y + 14, look->kind);
        draw_sign(d, x + 7, y + 7, look->kind);
        hn_canvas_text(d->c, x + 22, y + 12, TEXT_SIZE, HN_ALIGN_LEFT, d->ink, look->words);
    }
    hn_canvas_segment(d->c, x, y + 8, x + 14, y + 8, &thick);
    hn_canvas_text(d->c, x + 22, y + 12, TEXT_SIZE, HN_ALIGN_LEFT, d->ink,
                   "predicted from the spectrum");
    hn_canvas_segment(d->c, x, y + 30, x + 14, y + 30, &thin);
    hn_canvas_text(d->c, x + 22, y + 34, TEXT_SIZE, HN_ALIGN_LEFT, d->ink, "observed, to 2 %");
}

static void draw_method(drawing *d, int m) {
    hn_map_said_line said[HN_MAP_SAID_LINES];
    const int n = hn_map_said(d->map, m, said);
    double y = hn_map_field_top(m) - 12 - HN_MAP_SAID_HEIGHT * (n - 1);
    hn_canvas_text(d->c, HN_MAP_LEFT, y - 20, 15, HN_ALIGN_LEFT, d->ink, hn_map_method(d->map, m));
    for (int i = 0; i < n; i++, y += HN_MAP_SAID_HEIGHT) {
        hn_canvas_text(d->c, HN_MAP_LEFT, y, TEXT_SIZE, HN_ALIGN_LEFT, d->muted, said[i]);
    }
    draw_cells(d, m);
    draw_boundaries(d, m);
    draw_steep(d, m);
    draw_axes(d, m);
    draw_legend(d, m);
}

hn_status hn_map_png(hn_strbuf *png, const hn_map *map, hn_diag *diag) {
    drawing d = {.map = map, .surface = hn_surface_get(HN_THEME_LIGHT)};
    hn_status status =
        hn_canvas_create(HN_MAP_WIDTH, hn_map_height(map), HN_THEME_LIGHT, &d.c, diag);
    if (status != HN_OK) {
        return status;
    }
    d.ink = hn_paint_solid(d.surface->ink);
    d.muted = hn_paint_solid(d.surface->muted);
    for (int m = 0; m < hn_map_n_methods(map); m++) {
        draw_method(&d, m);
    }
    status = hn_canvas_png(d.c, png, diag);
    hn_canvas_free(d.c);
    return status;
}
