// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/raster.h"

#include "render/canvas_bounds.h"
#include "render/canvas_record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 128, SIDE = HN_CANVAS_SAMPLES * TILE, MAX_NUMBER = 255 };

/// The samples of a tile: colours, and the number of the layer that took each last. Samples of a
/// pixel count from its first shape on; a pixel without one is paper.
typedef struct tile {
    int x0, y0;     ///< [px], upper left corner
    uint32_t paper; ///< 0xRRGGBB
    bool touched[TILE * TILE];
    unsigned char rgb[SIDE * SIDE][3];
    unsigned char taken[SIDE * SIDE];
} tile;

/// Limits of the samples that a shape may take, within the tile.
typedef struct window {
    int x0, y0, x1, y1;
} window;

static int clamp(double x, int low, int high) {
    return x < low ? low : x > high ? high : (int)x;
}

static void set_sample(unsigned char *sample, uint32_t rgb) {
    for (int k = 0; k < 3; k++) {
        sample[k] = (unsigned char)(rgb >> (16 - 8 * k));
    }
}

static void blend(unsigned char *under, uint32_t rgb, double alpha) {
    if (alpha == 1) {
        set_sample(under, rgb);
        return;
    }
    for (int k = 0; k < 3; k++) {
        const double over = rgb >> (16 - 8 * k) & 0xff;
        under[k] = (unsigned char)lround(under[k] + alpha * (over - under[k]));
    }
}

static double smaller(double a, double b) {
    return a < b ? a : b;
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/// Widens the span of row `y` by the edge from p to q, where it crosses that row.
static void cross_row(const double *p, const double *q, double y, double span[2]) {
    if ((p[1] <= y) == (q[1] <= y)) {
        return;
    }
    const double x = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
    span[0] = smaller(span[0], x);
    span[1] = larger(span[1], x);
}

/// The samples of these columns of a row are paper where their pixels had no shape yet.
static void touch(tile *t, int row, int from, int to) {
    const int n = HN_CANVAS_SAMPLES, y = row / n;
    for (int x = from / n; x * n < to; x++) {
        if (t->touched[y * TILE + x]) {
            continue;
        }
        t->touched[y * TILE + x] = true;
        for (int j = 0; j < n * n; j++) {
            const int k = (n * y + j / n) * SIDE + n * x + j % n;
            set_sample(t->rgb[k], t->paper);
            t->taken[k] = 0;
        }
    }
}

/// Samples of a triangle (in samples of the tile) that no shape of this layer has taken yet.
static void fill_triangle(tile *t, double corner[3][2], const window *w, int number,
                          hn_paint paint) {
    const double top = smaller(corner[0][1], smaller(corner[1][1], corner[2][1]));
    const double bottom = larger(corner[0][1], larger(corner[1][1], corner[2][1]));
    const int first = clamp(ceil(top - 0.5), w->y0, w->y1);
    const int end = clamp(floor(bottom - 0.5) + 1, w->y0, w->y1);
    for (int row = first; row < end; row++) {
        double span[2] = {HUGE_VAL, -HUGE_VAL};
        for (int i = 0; i < 3; i++) {
            cross_row(corner[i], corner[(i + 1) % 3], row + 0.5, span);
        }
        const int from = clamp(ceil(span[0] - 0.5), w->x0, w->x1);
        const int to = clamp(floor(span[1] - 0.5) + 1, w->x0, w->x1);
        touch(t, row, from, to);
        for (int column = from; column < to; column++) {
            const int k = row * SIDE + column;
            if (t->taken[k] != number) {
                t->taken[k] = (unsigned char)number;
                blend(t->rgb[k], paint.rgb, paint.alpha);
            }
        }
    }
}

static void draw_shape(tile *t, const hn_canvas *c, const hn_canvas_shape *s, int number) {
    const int n = HN_CANVAS_SAMPLES;
    const window w = {
        clamp(n * (s->clip[0] - t->x0), 0, SIDE), clamp(n * (s->clip[1] - t->y0), 0, SIDE),
        clamp(n * (s->clip[2] - t->x0), 0, SIDE), clamp(n * (s->clip[3] - t->y0), 0, SIDE)};
    const hn_paint paint = {s->paint.rgb, s->paint.alpha * c->layers[s->layer]};
    for (int v = 0; v + 2 < s->count; v += 3) {
        double corner[3][2];
        if (hn_bounds_is_beside(hn_bounds_of(c->xy + 2 * (s->first + v), 3), t->x0, t->y0, TILE)) {
            continue;
        }
        for (int i = 0; i < 3; i++) {
            const float *xy = c->xy + 2 * (s->first + v + i);
            corner[i][0] = n * ((double)xy[0] - t->x0);
            corner[i][1] = n * ((double)xy[1] - t->y0);
        }
        fill_triangle(t, corner, &w, number, paint);
    }
}

/// Layers in their order; within a layer the last shape first, so that it lies on top.
static void draw_tile(tile *t, const hn_canvas *c, const hn_bounds *box) {
    t->paper = hn_surface_get(c->theme)->paper;
    memset(t->touched, 0, sizeof t->touched);
    int number = 0;
    for (int first = 0, end; first < c->n_shapes; first = end) {
        for (end = first + 1; end < c->n_shapes && c->shapes[end].layer == c->shapes[first].layer;
             end++) {}
        if (++number > MAX_NUMBER) {
            memset(t->taken, 0, sizeof t->taken);
            number = 1;
        }
        for (int i = end - 1; i >= first; i--) {
            if (c->shapes[i].count > 0 && !hn_bounds_is_beside(box[i], t->x0, t->y0, TILE)) {
                draw_shape(t, c, &c->shapes[i], number);
            }
        }
    }
}

/// Averages squares of samples into the pixels of the tile that are on the sheet.
static void average(const tile *t, const hn_canvas *c, unsigned char *rgb) {
    const int n = HN_CANVAS_SAMPLES, area = n * n;
    for (int y = t->y0; y < t->y0 + TILE && y < c->height; y++) {
        for (int x = t->x0; x < t->x0 + TILE && x < c->width; x++) {
            unsigned char *pixel = rgb + 3 * ((size_t)y * (size_t)c->width + (size_t)x);
            if (!t->touched[(y - t->y0) * TILE + x - t->x0]) {
                set_sample(pixel, t->paper);
                continue;
            }
            int sum[3] = {area / 2, area / 2, area / 2};
            for (int row = 0; row < n; row++) {
                const unsigned char *sample =
                    t->rgb[(n * (y - t->y0) + row) * SIDE + n * (x - t->x0)];
                for (int j = 0; j < 3 * n; j += 3) {
                    sum[0] += sample[j];
                    sum[1] += sample[j + 1];
                    sum[2] += sample[j + 2];
                }
            }
            for (int k = 0; k < 3; k++) {
                pixel[k] = (unsigned char)(sum[k] / area);
            }
        }
    }
}

hn_status hn_raster_paint(const hn_canvas *c, unsigned char *rgb, hn_diag *diag) {
    tile *t = malloc(sizeof *t);
    hn_bounds *box = hn_bounds_of_shapes(c);
    if (!t || !box) {
        free(t);
        free(box);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to paint a tile");
    }
    bool ends = false;
    for (t->y0 = 0; t->y0 < c->height; t->y0 += TILE) {
        for (t->x0 = 0; t->x0 < c->width && !ends; t->x0 += TILE) {
            draw_tile(t, c, box);
            average(t, c, rgb);
            ends = hn_interrupt_ask(c->interrupt);
        }
    }
    free(box);
    free(t);
    return !ends ? HN_OK
                 : hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL,
                               "the picture was not painted to its end");
}
