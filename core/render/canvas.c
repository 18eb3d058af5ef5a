// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/canvas.h"

#include "render/canvas_record.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { FIRST_CAP = 256 };
static const double PI = 3.14159265358979324;

static hn_status check_size(int size, const char *pointer, hn_diag *diag) {
    if (size < HN_CANVAS_MIN || size > HN_CANVAS_MAX) {
        return hn_diag_set(diag, HN_ERR_LIMIT, pointer, NULL,
                           "%d pixels were asked for; %d to %d are allowed", size, HN_CANVAS_MIN,
                           HN_CANVAS_MAX);
    }
    return HN_OK;
}

hn_status hn_canvas_create(int width, int height, hn_theme theme, hn_canvas **out, hn_diag *diag) {
    HN_ASSERT(out != NULL && (int)theme >= 0 && theme < HN_THEME_COUNT);
    HN_TRY(check_size(width, "/width", diag));
    HN_TRY(check_size(height, "/height", diag));
    hn_canvas *c = calloc(1, sizeof *c);
    if (c == NULL) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory for a canvas");
    }
    c->width = width;
    c->height = height;
    c->theme = theme;
    hn_canvas_unclip(c);
    *out = c;
    return HN_OK;
}

void hn_canvas_free(hn_canvas *c) {
    if (c != NULL) {
        free(c->xy);
        free(c->pen_xy);
        free(c->pens);
        free(c->shapes);
        free(c->layers);
        free(c);
    }
}

void hn_canvas_interrupt(hn_canvas *c, const hn_interrupt *interrupt) {
    c->interrupt = interrupt;
}

int hn_canvas_width(const hn_canvas *c) {
    return c->width;
}

int hn_canvas_height(const hn_canvas *c) {
    return c->height;
}

hn_theme hn_canvas_theme(const hn_canvas *c) {
    return c->theme;
}

hn_paint hn_paint_solid(uint32_t rgb) {
    return (hn_paint){rgb, 1};
}

hn_stroke hn_stroke_solid(uint32_t rgb, double width) {
    return (hn_stroke){.paint = {rgb, 1}, .width = width};
}

// ---- recording ----

/// Room for `more` items of `size` bytes; 0, and the canvas failed, when memory is out.
static bool make_room(hn_canvas *c, void **items, int *cap, int n, int more, size_t size) {
    if (c->failed || more > INT_MAX / 4 - n) {
        c->failed = 1;
        return false;
    }
    if (n + more <= *cap) {
        return true;
    }
    int wanted = *cap > 0 ? *cap : FIRST_CAP;
    while (wanted < n + more) {
        wanted *= 2;
    }
    void *grown = realloc(*items, (size_t)wanted * size);
    if (grown == NULL) {
        c->failed = 1;
        return false;
    }
    *items = grown;
    *cap = wanted;
    return true;
}

static bool add_layer(hn_canvas *c, double opacity) {
    if (!make_room(c, (void **)&c->layers, &c->cap_layers, c->n_layers, 1, sizeof *c->layers)) {
        return false;
    }
    c->layers[c->n_layers++] = fmin(1, fmax(0, opacity));
    return true;
}

void hn_record_begin(hn_canvas *c, hn_paint paint) {
    if (!c->in_layer && !add_layer(c, 1)) {
        return;
    }
    if (!make_room(c, (void **)&c->shapes, &c->cap_shapes, c->n_shapes, 1, sizeof *c->shapes)) {
        return;
    }
    hn_canvas_shape *s = &c->shapes[c->n_shapes++];
    *s = (hn_canvas_shape){
        .paint = paint, .first = c->n_xy / 2, .pen = c->n_pens, .layer = c->n_layers - 1};
    memcpy(s->clip, c->clip, sizeof s->clip);
}

void hn_record_triangle(hn_canvas *c, const double a[2], const double b[2], const double d[2]) {
    if (!make_room(c, (void **)&c->xy, &c->cap_xy, c->n_xy, 6, sizeof *c->xy)) {
        return;
    }
    const double *const corners[3] = {a, b, d};
    for (int i = 0; i < 3; i++) {
        c->xy[c->n_xy++] = (float)corners[i][0];
        c->xy[c->n_xy++] = (float)corners[i][1];
    }
}

void hn_record_end(hn_canvas *c) {
    if (c->failed) {
        return;
    }
    hn_canvas_shape *s = &c->shapes[c->n_shapes - 1];
    s->count = c->n_xy / 2 - s->first;
    s->n_pens = c->n_pens - s->pen;
}

void hn_record_pen(hn_canvas *c, const double *xy, int n, int closed, double width, int vertex) {
    if (!make_room(c, (void **)&c->pen_xy, &c->cap_pen_xy, c->n_pen_xy, 2 * n, sizeof *c->pen_xy) ||
        !make_room(c, (void **)&c->pens, &c->cap_pens, c->n_pens, 1, sizeof *c->pens)) {
        return;
    }
    c->pens[c->n_pens++] = (hn_canvas_pen){.first = c->n_pen_xy / 2,
                                           .n = n,
                                           .closed = closed,
                                           .vertex = vertex,
                                           .count = c->n_xy / 2 - vertex,
                                           .width = (float)width};
    for (int i = 0; i < 2 * n; i++) {
        c->pen_xy[c->n_pen_xy++] = (float)xy[i];
    }
}

void hn_canvas_begin_layer(hn_canvas *c, double opacity) {
    HN_ASSERT(!c->in_layer);
    c->in_layer = 1;
    add_layer(c, opacity);
}

void hn_canvas_end_layer(hn_canvas *c) {
    HN_ASSERT(c->in_layer);
    c->in_layer = 0;
}

static int clamp(int value, int low, int high) {
    return value < low ? low : value > high ? high : value;
}

void hn_canvas_clip(hn_canvas *c, int x, int y, int width, int height) {
    HN_ASSERT(width >= 0 && height >= 0);
    c->clip[0] = clamp(x, 0, c->width);
    c->clip[1] = clamp(y, 0, c->height);
    c->clip[2] = clamp(x + width, 0, c->width);
    c->clip[3] = clamp(y + height, 0, c->height);
}

void hn_canvas_unclip(hn_canvas *c) {
    hn_canvas_clip(c, 0, 0, c->width, c->height);
}

// ---- filled shapes ----

/// Corners of a circle so that its chords stay within 0.05 px of it.
static int circle_steps(double radius) {
    const double steps = PI / acos(1 - 0.05 / fmax(radius, 0.1));
    return clamp(isfinite(steps) ? (int)ceil(steps) : 8, 8, 256);
}

void hn_record_disc(hn_canvas *c, double x, double y, double radius) {
    if (!isfinite(x) || !isfinite(y) || !(radius > 0)) {
        return;
    }
    const int n = circle_steps(radius);
    const double centre[2] = {x, y};
    double last[2] = {x + radius, y};
    for (int i = 1; i <= n; i++) {
        const double a = 2 * PI * i / n;
        const double next[2] = {x + radius * cos(a), y + radius * sin(a)};
        hn_record_triangle(c, centre, last, next);
        memcpy(last, next, sizeof last);
    }
}

void hn_canvas_disc(hn_canvas *c, double x, double y, double radius, hn_paint paint) {
    hn_record_begin(c, paint);
    hn_record_disc(c, x, y, radius);
    hn_record_end(c);
}

static double cross(const double *o, const double *a, const double *b) {
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

static double signed_area(const double *xy, int n) {
    double twice = 0;
    for (int i = 0, j = n - 1; i < n; j = i++) {
        twice += xy[2 * j] * xy[2 * i + 1] - xy[2 * i] * xy[2 * j + 1];
    }
    return twice / 2;
}

/// 1 if corner i of the ring is an ear: convex, and no other corner inside its triangle.
static bool is_ear(const double *xy, const int *ring, int n, int i, double sense) {
    const double *a = xy + 2 * ring[(i + n - 1) % n], *b = xy + 2 * ring[i],
                 *d = xy + 2 * ring[(i + 1) % n];
    if (sense * cross(a, b, d) <= 0) {
        return false;
    }
    for (int k = 0; k < n; k++) {
        const double *p = xy + 2 * ring[k];
        if (p == a || p == b || p == d) {
            continue;
        }
        if (sense * cross(a, b, p) > 0 && sense * cross(b, d, p) > 0 &&
            sense * cross(d, a, p) > 0) {
            return false;
        }
    }
    return true;
}

/// Cuts off ears (Meisters, American Mathematical Monthly 82 (1975) 648); O(n^3) at worst, polygons
/// are small.
static void record_polygon(hn_canvas *c, const double *xy, int n, int *ring) {
    const double sense = signed_area(xy, n) >= 0 ? 1 : -1;
    for (int i = 0; i < n; i++) {
        ring[i] = i;
    }
    while (n > 3) {
        int ear = 0;
        while (ear < n && !is_ear(xy, ring, n, ear, sense)) {
            ear++;
        }
        // corners in one line or a polygon that crosses itself: any corner will do
        ear = ear < n ? ear : 0;
        hn_record_triangle(c, xy + 2 * ring[(ear + n - 1) % n], xy + 2 * ring[ear],
                           xy + 2 * ring[(ear + 1) % n]);
        memmove(ring + ear, ring + ear + 1, (size_t)(n - ear - 1) * sizeof *ring);
        n--;
    }
    hn_record_triangle(c, xy + 2 * ring[0], xy + 2 * ring[1], xy + 2 * ring[2]);
}

void hn_canvas_polygon(hn_canvas *c, const double *xy, int n, hn_paint paint) {
    HN_ASSERT(n >= 3);
    for (int i = 0; i < 2 * n; i++) {
        if (!isfinite(xy[i])) {
            return;
        }
    }
    int *ring = malloc((size_t)n * sizeof *ring);
    if (ring == NULL) {
        c->failed = 1;
        return;
    }
    hn_record_begin(c, paint);
    record_polygon(c, xy, n, ring);
    hn_record_end(c);
    free(ring);
}

int hn_canvas_capsule(double x0, double y0, double x1, double y1, double width,
                      double xy[2 * HN_CAPSULE_POINTS]) {
    const double along = atan2(y1 - y0, x1 - x0), r = width / 2;
    const int half = HN_CAPSULE_POINTS / 2;
    for (int i = 0; i < half; i++) {
        const double a = along + PI / 2 + PI * i / (half - 1);
        xy[2 * i] = x0 + r * cos(a);
        xy[2 * i + 1] = y0 + r * sin(a);
        xy[2 * (i + half)] = x1 - r * cos(a);
        xy[2 * (i + half) + 1] = y1 - r * sin(a);
    }
    return 2 * half;
}
