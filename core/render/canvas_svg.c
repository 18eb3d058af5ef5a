// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/canvas_svg.h"

#include "render/canvas_record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/// A corner, relative to the one before; `at` follows.
static void put_corner(hn_strbuf *b, const char *command, const float *xy, long at[2]) {
    const long to[2] = {lround(100 * (double)xy[0]), lround(100 * (double)xy[1])};
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

/// How many triangles from the v-th vertex on make a fan: one first corner, each begins where the
/// one before ended, and all turn one way.
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
    put_corner(b, "m", closed ? rim(xy, n, 0) : xy, at);
    const long begin[2] = {at[0], at[1]};
    for (int i = closed; i <= n - closed; i++) {
        put_corner(b, "l", rim(xy, n, turn ? i : n - i), at);
    }
    hn_strbuf_add(b, "z");
    at[0] = begin[0];
    at[1] = begin[1];
}

static void put_path(hn_strbuf *b, const hn_canvas *c, const hn_canvas_shape *s) {
    hn_strbuf_printf(b, "<path fill=\"#%06x\"", s->paint.rgb);
    if (s->paint.alpha < 1) {
        hn_strbuf_printf(b, " fill-opacity=\"%.3g\"", s->paint.alpha);
    }
    hn_strbuf_add(b, " d=\"");
    const int triangles = s->count / 3;
    long at[2] = {0, 0};
    for (int t = 0, n; t < triangles; t += n) {
        const float *xy = c->xy + 2 * (s->first + 3 * t);
        n = fan_length(xy, triangles - t);
        put_fan(b, xy, n, at);
    }
    hn_strbuf_add(b, "\"/>\n");
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
    put_path(b, c, s);
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
    hn_strbuf_add(out, "</desc>\n");
    for (int i = 0; i < n; i++) {
        failed |= canvases[i]->failed != 0;
        put_canvas(out, canvases[i], i, i % columns * width, i / columns * height);
    }
    hn_strbuf_add(out, "</svg>\n");
    return failed || out->failed
               ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "memory ran out while drawing")
               : HN_OK;
}
