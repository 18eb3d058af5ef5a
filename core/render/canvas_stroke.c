// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of the canvas, and what is made of lines: rings, arrows, hatching, markers, text.
#include "render/canvas.h"

#include "render/canvas_record.h"
#include "render/font.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { RING_POINTS = 96 };
static const double HATCH_PITCH = 3.2; // widths of the stroke between two strokes of hatching
static const double PI = 3.14159265358979324;
static const double SHORTEST = 1e-9; // [px] segments below this have no direction
static const double LONGEST_DASHED =
    1e5; // [px] beyond this a dashed line is off any sheet and is drawn in full
static const double TEXT_STROKE = 0.085; // of the font size

static bool is_point(const double *p) {
    return isfinite(p[0]) && isfinite(p[1]);
}

static void record_segment(hn_canvas *c, const double *p, const double *q, double width) {
    const double dx = q[0] - p[0], dy = q[1] - p[1], length = hypot(dx, dy);
    if (!(length > SHORTEST)) {
        return;
    }
    const double nx = -dy / length * width / 2, ny = dx / length * width / 2;
    const double corner[4][2] = {{p[0] + nx, p[1] + ny},
                                 {q[0] + nx, q[1] + ny},
                                 {q[0] - nx, q[1] - ny},
                                 {p[0] - nx, p[1] - ny}};
    hn_record_triangle(c, corner[0], corner[1], corner[2]);
    hn_record_triangle(c, corner[0], corner[2], corner[3]);
}

/// The triangles of a run of points, all finite.
static void record_run(hn_canvas *c, const double *xy, int n, int closed, double width) {
    const int vertex = c->n_xy / 2;
    for (int i = 0; i < n; i++) {
        hn_record_disc(c, xy[2 * i], xy[2 * i + 1], width / 2);
        const int next = i + 1 < n ? i + 1 : closed ? 0 : -1;
        if (next >= 0) {
            record_segment(c, xy + 2 * i, xy + 2 * next, width);
        }
    }
    hn_record_pen(c, xy, n, closed, width, vertex);
}

/// Adds the triangles of a stroked line to the open shape.
static void record_stroke(hn_canvas *c, const double *xy, int n, int closed, double width) {
    int begin = 0;
    for (int i = 0; i <= n; i++) {
        if (i == n || !is_point(xy + 2 * i)) {
            if (i > begin) {
                record_run(c, xy + 2 * begin, i - begin, closed && begin == 0 && i == n, width);
            }
            begin = i + 1;
        }
    }
    // the last run of a closed line goes on in its first
    const bool whole = n > 1 && closed && is_point(xy) && is_point(xy + 2 * (n - 1));
    bool broken = false;
    for (int i = 1; i + 1 < n; i++) {
        broken |= !is_point(xy + 2 * i);
    }
    if (whole && broken) {
        const double ends[4] = {xy[2 * n - 2], xy[2 * n - 1], xy[0], xy[1]};
        record_run(c, ends, 2, 0, width);
    }
}

// ---- dashes ----

// where a walk along a dashed line is: the dash, how much of it is left, and the start of the piece
// now on
typedef struct dash_walk {
    const hn_stroke *stroke;
    int index;
    double left;
} dash_walk;

static void next_dash(dash_walk *w) {
    w->index = (w->index + 1) % w->stroke->n_dash;
    w->left = w->stroke->dash[w->index];
}

/// The part a..b (distances from p) of a dash, shortened by its round ends where it begins or ends
/// there.
static void record_dash(hn_canvas *c, const double *p, const double *dir, double a, double b,
                        int begins, int ends, double width) {
    a += begins ? width / 2 : 0;
    b -= ends ? width / 2 : 0;
    if (b < a) {
        a = b = (a + b) / 2;
    }
    const double xy[4] = {p[0] + a * dir[0], p[1] + a * dir[1], p[0] + b * dir[0],
                          p[1] + b * dir[1]};
    record_stroke(c, xy, 2, 0, width);
}

static void record_dashed_segment(hn_canvas *c, const double *p, const double *q, dash_walk *w) {
    const double length = hypot(q[0] - p[0], q[1] - p[1]);
    if (!(length > SHORTEST)) {
        return;
    }
    const double dir[2] = {(q[0] - p[0]) / length, (q[1] - p[1]) / length};
    for (double at = 0; at < length;) {
        const double step = fmin(w->left, length - at);
        const int begins = w->left == w->stroke->dash[w->index], ends = w->left <= length - at;
        if (w->index % 2 == 0) {
            record_dash(c, p, dir, at, at + step, begins, ends, w->stroke->width);
        }
        at += step;
        w->left -= step;
        if (ends) {
            next_dash(w);
        }
    }
}

static bool dashes_are_usable(const hn_stroke *s, const double *xy, int n) {
    double length = 0;
    for (int i = 1; i < n; i++) {
        length += hypot(xy[2 * i] - xy[2 * i - 2], xy[2 * i + 1] - xy[2 * i - 1]);
    }
    return s->n_dash > 0 && isfinite(length) && length < LONGEST_DASHED;
}

static void record_dashed(hn_canvas *c, const double *xy, int n, const hn_stroke *stroke) {
    dash_walk walk = {stroke, 0, stroke->dash[0]};
    for (int i = 0; i + 1 < n + (stroke->closed != 0); i++) {
        record_dashed_segment(c, xy + 2 * i, xy + 2 * ((i + 1) % n), &walk);
    }
}

void hn_canvas_line(hn_canvas *c, const double *xy, int n, const hn_stroke *stroke) {
    HN_ASSERT(stroke->n_dash % 2 == 0);
    for (int i = 0; i < stroke->n_dash; i++) {
        HN_ASSERT(stroke->dash[i] > 0);
    }
    hn_record_begin(c, stroke->paint);
    if (dashes_are_usable(stroke, xy, n)) {
        record_dashed(c, xy, n, stroke);
    } else {
        record_stroke(c, xy, n, stroke->closed, stroke->width);
    }
    hn_record_end(c);
}

void hn_canvas_segment(hn_canvas *c, double x0, double y0, double x1, double y1,
                       const hn_stroke *stroke) {
    const double xy[4] = {x0, y0, x1, y1};
    hn_canvas_line(c, xy, 2, stroke);
}

// ---- made of lines ----

void hn_canvas_ring(hn_canvas *c, double x, double y, double radius, const hn_stroke *stroke) {
    double xy[2 * RING_POINTS];
    for (int i = 0; i < RING_POINTS; i++) {
        const double a = 2 * PI * i / RING_POINTS;
        xy[2 * i] = x + radius * cos(a);
        xy[2 * i + 1] = y + radius * sin(a);
    }
    hn_stroke closed = *stroke;
    closed.closed = 1;
    hn_canvas_line(c, xy, RING_POINTS, &closed);
}

void hn_canvas_arc(hn_canvas *c, double x, double y, double radius, double from, double to,
                   const hn_stroke *stroke) {
    double xy[2 * (RING_POINTS + 1)];
    const double turn = fmin(2 * PI, fabs(to - from));
    const int n = 2 + (int)((RING_POINTS - 1) * turn / (2 * PI));
    for (int i = 0; i < n; i++) {
        const double a = from + (to - from) * i / (n - 1);
        xy[2 * i] = x + radius * cos(a);
        xy[2 * i + 1] = y + radius * sin(a);
    }
    hn_canvas_line(c, xy, n, stroke);
}

void hn_canvas_arrow(hn_canvas *c, double x0, double y0, double x1, double y1, double head,
                     const hn_stroke *stroke) {
    const double length = hypot(x1 - x0, y1 - y0);
    if (!(length > SHORTEST) || !isfinite(length)) {
        return;
    }
    const double ux = (x1 - x0) / length, uy = (y1 - y0) / length, h = fmin(head, length);
    const double base[2] = {x1 - h * ux, y1 - h * uy}, wing = 0.4 * h;
    const double a[2] = {base[0] - wing * uy, base[1] + wing * ux},
                 b[2] = {base[0] + wing * uy, base[1] - wing * ux};
    const double tip[2] = {x1, y1}, shaft[4] = {x0, y0, base[0], base[1]};
    hn_record_begin(c, stroke->paint);
    record_stroke(c, shaft, 2, 0, stroke->width);
    hn_record_triangle(c, tip, a, b);
    hn_record_end(c);
}

double hn_canvas_hatch_depth(double width) {
    return 1.1 * HATCH_PITCH * width;
}

void hn_canvas_hatch_plane(hn_canvas *c, double x, double y, double length, const double along[2],
                           const double away[2], const hn_stroke *stroke) {
    const double pitch = HATCH_PITCH * stroke->width, depth = hn_canvas_hatch_depth(stroke->width);
    const int n = length > pitch ? (int)(length / pitch) : 1;
    const double line[4] = {x - length / 2 * along[0], y - length / 2 * along[1],
                            x + length / 2 * along[0], y + length / 2 * along[1]};
    hn_record_begin(c, stroke->paint);
    record_stroke(c, line, 2, 0, stroke->width);
    for (int i = 0; i < n; i++) {
        const double s = (i + 1 - 0.5 * n) * length / n;
        const double px = x + s * along[0], py = y + s * along[1];
        const double slant[4] = {px, py, px - depth * along[0] + depth * away[0],
                                 py - depth * along[1] + depth * away[1]};
        record_stroke(c, slant, 2, 0, 0.75 * stroke->width);
    }
    hn_record_end(c);
}

void hn_canvas_hatch(hn_canvas *c, double x, double y, double length, double angle,
                     const hn_stroke *stroke) {
    const double along[2] = {cos(angle), sin(angle)}, away[2] = {-along[1], along[0]};
    hn_canvas_hatch_plane(c, x, y, length, along, away, stroke);
}

static void lines_marker(hn_canvas *c, const double *offsets, double x, double y, double r,
                         hn_paint paint) {
    hn_record_begin(c, paint);
    for (int i = 0; i < 2; i++) {
        const double *o = offsets + 4 * i;
        const double xy[4] = {x + r * o[0], y + r * o[1], x + r * o[2], y + r * o[3]};
        record_stroke(c, xy, 2, 0, 0.5 * r);
    }
    hn_record_end(c);
}

static void polygon_marker(hn_canvas *c, const double *corners, int n, double x, double y, double r,
                           hn_paint paint) {
    double xy[8];
    for (int i = 0; i < n; i++) {
        xy[2 * i] = x + r * corners[2 * i];
        xy[2 * i + 1] = y + r * corners[2 * i + 1];
    }
    hn_canvas_polygon(c, xy, n, paint);
}

/// The outline of a square.
static void box_marker(hn_canvas *c, const double *corners, double x, double y, double r,
                       hn_paint paint) {
    hn_record_begin(c, paint);
    for (int i = 0; i < 4; i++) {
        const double *p = corners + 2 * i, *q = corners + 2 * ((i + 1) % 4);
        const double xy[4] = {x + r * p[0], y + r * p[1], x + r * q[0], y + r * q[1]};
        record_stroke(c, xy, 2, 0, 0.45 * r);
    }
    hn_record_end(c);
}

void hn_canvas_marker(hn_canvas *c, hn_marker marker, double x, double y, double size,
                      hn_paint paint) {
    static const double square[] = {-0.85, -0.85, 0.85, -0.85, 0.85, 0.85, -0.85, 0.85};
    static const double triangle[] = {0, -1.1, 1, 0.75, -1, 0.75};
    static const double diamond[] = {0, -1.2, 1.2, 0, 0, 1.2, -1.2, 0};
    static const double slanted[] = {-0.8, -0.8, 0.8, 0.8, -0.8, 0.8, 0.8, -0.8};
    static const double upright[] = {-1, 0, 1, 0, 0, -1, 0, 1};
    const double r = size / 2;
    const hn_stroke thin = {.paint = paint, .width = 0.45 * r};

    // one shape each
    switch (marker) {
    case HN_MARKER_DISC:
        hn_canvas_disc(c, x, y, r, paint);
        break;
    case HN_MARKER_SQUARE:
        polygon_marker(c, square, 4, x, y, r, paint);
        break;
    case HN_MARKER_TRIANGLE:
        polygon_marker(c, triangle, 3, x, y, r, paint);
        break;
    case HN_MARKER_DIAMOND:
        polygon_marker(c, diamond, 4, x, y, r, paint);
        break;
    case HN_MARKER_CROSS:
        lines_marker(c, slanted, x, y, r, paint);
        break;
    case HN_MARKER_RING:
        hn_canvas_ring(c, x, y, 0.8 * r, &thin);
        break;
    case HN_MARKER_PLUS:
        lines_marker(c, upright, x, y, r, paint);
        break;
    case HN_MARKER_BOX:
        box_marker(c, square, x, y, r, paint);
        break;
    case HN_MARKER_DOT:
        hn_canvas_disc(c, x, y, 0.45 * r, paint);
        break;
    case HN_MARKER_COUNT:
        break;
    }
}

// ---- text ----

static double font_scale(double size) {
    return 0.7 * size / HN_FONT_CAP;
}

double hn_canvas_text_width(double size, const char *utf8) {
    double units = 0;
    for (uint32_t code; (code = hn_utf8_next(&utf8)) != 0;) {
        units += hn_font_advance(code);
    }
    return units * font_scale(size);
}

static void record_glyph(hn_canvas *c, const hn_glyph *g, double x, double y, double size) {
    const double scale = font_scale(size);
    double xy[2 * HN_FONT_MAX_POINTS];
    for (int i = 0; i < g->n_points; i++) {
        xy[2 * i] = x + scale * g->xy[2 * i];
        xy[2 * i + 1] = y - scale * g->xy[2 * i + 1];
    }
    for (int i = 0; i < g->n_lines; i++) {
        record_stroke(c, xy + 2 * g->start[i], g->start[i + 1] - g->start[i], 0,
                      TEXT_STROKE * size);
    }
}

void hn_canvas_text(hn_canvas *c, double x, double y, double size, hn_align align, hn_paint paint,
                    const char *utf8) {
    const double width = align == HN_ALIGN_LEFT ? 0 : hn_canvas_text_width(size, utf8);
    double at = align == HN_ALIGN_CENTRE ? x - width / 2 : x - width;
    hn_record_begin(c, paint);
    for (uint32_t code; (code = hn_utf8_next(&utf8)) != 0;) {
        hn_glyph glyph;
        hn_font_glyph(code, &glyph);
        record_glyph(c, &glyph, at, y, size);
        at += glyph.advance * font_scale(size);
    }
    hn_record_end(c);
}
