// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/canvas_svg.h"

#include "render/canvas_record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PEN_GRID = 5 };             // hundredths of a pixel: ends of lines
static const double UNSEEN = 0.03; // [px] by which a line may pass a point that is left out

static void put_escaped(hn_strbuf *b, const char *text) {
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '<' || c == '>' || c == '&') {
            hn_strbuf_printf(b, "&#%d;", c);
        } else if (c >= ' ') {
            hn_strbuf_add_n(b, text, 1);
        }
    }
}

/// Hundredths of a pixel as a number without needless zeros, after a blank where one is needed.
static void put_number(hn_strbuf *b, long hundredths, bool first) {
    char text[40];
    const long size = labs(hundredths);
    int n = snprintf(text, sizeof text, "%s", hundredths < 0 ? "-" : first ? "" : " ");
    if (size >= 100 || size == 0) {
        n += snprintf(text + n, sizeof text - (size_t)n, "%ld", size / 100);
    }
    if (size % 100) {
        const int tenth = size % 10 == 0;
        n += snprintf(text + n, sizeof text - (size_t)n, tenth ? ".%ld" : ".%02ld",
                      tenth ? size % 100 / 10 : size % 100);
    }
    hn_strbuf_add_n(b, text, (size_t)n);
}

/// A corner, relative to the one before, rounded to `grid` hundredths of a pixel; `at` follows.
static void put_corner(hn_strbuf *b, const char *command, const float *xy, int grid, long at[2]) {
    const long to[2] = {lround(100.0 / grid * (double)xy[0]) * grid,
                        lround(100.0 / grid * (double)xy[1]) * grid};
    hn_strbuf_add(b, command);
    put_number(b, to[0] - at[0], true);
    put_number(b, to[1] - at[1], false);
    at[0] = to[0];
    at[1] = to[1];
}

static bool same_corner(const float *a, const float *b) {
    return memcmp(a, b, 2 * sizeof *a) == 0;
}

static double twice_area(const float *p, const float *q, const float *r) {
    return ((double)q[0] - (double)p[0]) * ((double)r[1] - (double)p[1]) -
           ((double)r[0] - (double)p[0]) * ((double)q[1] - (double)p[1]);
}

/// Returns how many triangles from the v-th vertex on make a fan: one first corner, each begins
/// where the one before ended, and all turn one way.
static int fan_length(const float *xy, int left) {
    const bool turn = twice_area(xy, xy + 2, xy + 4) >= 0;
    int n = 1;
    while (n < left && same_corner(xy, xy + 6 * n) && same_corner(xy + 6 * n - 2, xy + 6 * n + 2) &&
           (twice_area(xy + 6 * n, xy + 6 * n + 2, xy + 6 * n + 4) >= 0) == turn) {
        n++;
    }
    return n;
}

/// The k-th corner of the rim of a fan, 0 to n.
static const float *rim(const float *xy, int n, int k) {
    return k < n ? xy + 6 * k + 2 : xy + 6 * (n - 1) + 4;
}

/// A fan of n triangles as one polygon, turned like all others: where they overlap they are one
/// area. A fan that closes round its first corner needs the rim alone. `at`: where the pen is.
static void put_fan(hn_strbuf *b, const float *xy, int n, long at[2]) {
    const bool turn = twice_area(xy, xy + 2, xy + 4) >= 0;
    const bool closed = n > 2 && same_corner(rim(xy, n, 0), rim(xy, n, n));
    put_corner(b, "m", closed ? rim(xy, n, 0) : xy, 1, at);
    const long begin[2] = {at[0], at[1]};
    for (int i = closed; i <= n - closed; i++) {
        put_corner(b, "l", rim(xy, n, turn ? i : n - i), 1, at);
    }
    hn_strbuf_add(b, "z");
    at[0] = begin[0];
    at[1] = begin[1];
}

/// Begins a path of one colour, filled, or drawn with a pen of this width.
static void begin_path(hn_strbuf *b, const hn_canvas_shape *s, double pen, bool alone) {
    if (pen > 0) {
        hn_strbuf_printf(b, "<path class=\"p\" stroke=\"#%06x\" stroke-width=\"%.3g\"",
                         s->paint.rgb, pen);
    } else {
        hn_strbuf_printf(b, "<path fill=\"#%06x\"", s->paint.rgb);
    }
    if (s->paint.alpha < 1 && alone) {
        hn_strbuf_printf(b, " opacity=\"%.3g\"", s->paint.alpha);
    }
    hn_strbuf_add(b, " d=\"");
}

/// The pen that made a vertex; NULL: no pen did.
static const hn_canvas_pen *pen_of(const hn_canvas *c, const hn_canvas_shape *s, int vertex) {
    for (int i = 0; i < s->n_pens; i++) {
        const hn_canvas_pen *pen = &c->pens[s->pen + i];
        if (vertex >= pen->vertex && vertex < pen->vertex + pen->count) {
            return pen;
        }
    }
    return NULL;
}

/// Triangles that no pen made.
static int count_areas(const hn_canvas *c, const hn_canvas_shape *s) {
    int n = s->count;
    for (int i = 0; i < s->n_pens; i++) {
        n -= c->pens[s->pen + i].count;
    }
    return n / 3;
}

static void put_areas(hn_strbuf *b, const hn_canvas *c, const hn_canvas_shape *s, bool alone) {
    long at[2] = {0, 0};
    begin_path(b, s, 0, alone);
    for (int v = s->first; v < s->first + s->count;) {
        const hn_canvas_pen *pen = pen_of(c, s, v);
        if (pen) {
            v = pen->vertex + pen->count;
            continue;
        }

        // triangles up to the next pen
        int end = v;
        while (end < s->first + s->count && !pen_of(c, s, end)) {
            end += 3;
        }
        while (v < end) {
            const int n = fan_length(c->xy + 2 * v, (end - v) / 3);
            put_fan(b, c->xy + 2 * v, n, at);
            v += 3 * n;
        }
    }
    hn_strbuf_add(b, "\"/>\n");
}

/// Returns whether the point q lies on the line from p to the point after q, as far as it can be
/// seen.
static bool is_between(const float *p, const float *q) {
    const double length = hypot((double)q[2] - (double)p[0], (double)q[3] - (double)p[1]);
    return fabs(twice_area(p, q, q + 2)) <= UNSEEN * length;
}

static void put_pen(hn_strbuf *b, const hn_canvas *c, const hn_canvas_pen *pen, long at[2]) {
    const float *xy = c->pen_xy + 2 * pen->first;
    put_corner(b, "m", xy, PEN_GRID, at);
    const long begin[2] = {at[0], at[1]};
    for (int i = 1, last = 0; i < pen->n; i++) {
        // a point that the line would pass anyway; never two after each other
        if (i == last + 1 && i + 1 < pen->n && is_between(xy + 2 * last, xy + 2 * i)) {
            continue;
        }
        put_corner(b, "l", xy + 2 * i, PEN_GRID, at);
        last = i;
    }
    hn_strbuf_add(b, pen->closed ? "z" : pen->n == 1 ? "h0" : "");
    if (pen->closed) {
        at[0] = begin[0];
        at[1] = begin[1];
    }
}

/// One path for the pens of each width.
static void put_pens(hn_strbuf *b, const hn_canvas *c, const hn_canvas_shape *s, bool alone) {
    for (int i = 0; i < s->n_pens; i++) {
        const float width = c->pens[s->pen + i].width;
        bool first = true;
        for (int k = 0; k < i; k++) {
            first &= c->pens[s->pen + k].width != width;
        }
        if (first) {
            long at[2] = {0, 0};
            begin_path(b, s, (double)width, alone);
            for (int k = i; k < s->n_pens; k++) {
                if (c->pens[s->pen + k].width == width) {
                    put_pen(b, c, &c->pens[s->pen + k], at);
                }
            }
            hn_strbuf_add(b, "\"/>\n");
        }
    }
}

/// Returns whether a shape needs one path alone.
static bool is_one_path(const hn_canvas *c, const hn_canvas_shape *s) {
    bool same = s->n_pens == 0 || count_areas(c, s) == 0;
    for (int i = 1; i < s->n_pens; i++) {
        same &= c->pens[s->pen + i].width == c->pens[s->pen].width;
    }
    return same;
}

/// A shape of several paths has one opacity for all: it does not cover itself twice.
static void put_paths(hn_strbuf *b, const hn_canvas *c, const hn_canvas_shape *s) {
    const bool one = is_one_path(c, s), group = !one && s->paint.alpha < 1;
    if (group) {
        hn_strbuf_printf(b, "<g opacity=\"%.3g\">\n", s->paint.alpha);
    }
    if (count_areas(c, s) > 0) {
        put_areas(b, c, s, one);
    }
    put_pens(b, c, s, one);
    hn_strbuf_add(b, group ? "</g>\n" : "");
}

/// A shape, within its rectangle where that is not the whole sheet.
static void put_shape(hn_strbuf *b, const hn_canvas *c, int canvas, int shape) {
    const hn_canvas_shape *s = &c->shapes[shape];
    const int *k = s->clip;
    const bool whole = k[0] == 0 && k[1] == 0 && k[2] == c->width && k[3] == c->height;
    if (s->count == 0) {
        return;
    }
    if (!whole) {
        hn_strbuf_printf(b,
                         "<clipPath id=\"k%d-%d\"><rect x=\"%d\" y=\"%d\" width=\"%d\" "
                         "height=\"%d\"/></clipPath><g clip-path=\"url(#k%d-%d)\">\n",
                         canvas, shape, k[0], k[1], k[2] - k[0], k[3] - k[1], canvas, shape);
    }
    put_paths(b, c, s);
    hn_strbuf_add(b, whole ? "" : "</g>\n");
}

static void put_canvas(hn_strbuf *b, const hn_canvas *c, int canvas, int x, int y) {
    hn_strbuf_printf(b, "<svg x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\">\n", x, y, c->width,
                     c->height);
    hn_strbuf_printf(b, "<rect width=\"100%%\" height=\"100%%\" fill=\"#%06x\"/>\n",
                     hn_surface_get(c->theme)->paper);
    for (int first = 0, end; first < c->n_shapes; first = end) {
        const int layer = c->shapes[first].layer;
        const bool group = c->layers[layer] < 1;
        if (group) {
            hn_strbuf_printf(b, "<g opacity=\"%.3g\">\n", c->layers[layer]);
        }
        for (end = first; end < c->n_shapes && c->shapes[end].layer == layer; end++) {
            put_shape(b, c, canvas, end);
        }
        hn_strbuf_add(b, group ? "</g>\n" : "");
    }
    hn_strbuf_add(b, "</svg>\n");
}

hn_status hn_canvas_svg(hn_strbuf *out, hn_canvas *const *canvases, int n, int columns,
                        const char *title, const char *about, hn_diag *diag) {
    HN_ASSERT(out && canvases && n >= 1 && columns >= 1);
    const int width = canvases[0]->width, height = canvases[0]->height;
    const int across = n < columns ? n : columns, down = (n + columns - 1) / columns;
    bool failed = false;
    hn_strbuf_printf(out,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                     "viewBox=\"0 0 %d %d\" role=\"img\">\n<title>",
                     across * width, down * height, across * width, down * height);
    put_escaped(out, title ? title : "");
    hn_strbuf_add(out, "</title>\n<desc>");
    put_escaped(out, about ? about : "");
    hn_strbuf_add(out, "</desc>\n<style>.p{fill:none;stroke-linecap:round;"
                       "stroke-linejoin:round}</style>\n");
    for (int i = 0; i < n; i++) {
        failed |= canvases[i]->failed != 0;
        put_canvas(out, canvases[i], i, i % columns * width, i / columns * height);
    }
    hn_strbuf_add(out, "</svg>\n");
    return failed || out->failed
               ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "memory ran out while drawing")
               : HN_OK;
}
