// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_places.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double HALO = 0.8;  // how far the paper behind a text covers what is there
static const double TALL = 0.5;  // [letters] half of the height of a text
static const double PAPER = 2;   // [px] of paper around a text
static const double APART = 0.3; // [letters] between two texts of one line

void hn_label_remember(hn_label_places *placed, hn_label_kind kind, const char *text,
                       const double xy[2], double half) {
    if (placed->n < HN_LABELS_PLACED) {
        memcpy(placed->at[placed->n], xy, 2 * sizeof *xy);
        placed->kind[placed->n] = kind;
        snprintf(placed->text[placed->n], HN_LABEL_TEXT, "%s", text);
        placed->half[placed->n++] = half;
    }
}

void hn_label_keep_off_line(hn_label_places *placed, const double line[2][2]) {
    if (placed->n_lines < HN_LABEL_LINES) {
        memcpy(placed->line[placed->n_lines++], line, sizeof *placed->line);
    }
}

void hn_label_keep_off_strip(hn_label_places *placed, const double from[2], const double to[2],
                             double half) {
    if (placed->n_strips < HN_LABEL_STRIPS) {
        memcpy(placed->strip[placed->n_strips][0], from, 2 * sizeof *from);
        memcpy(placed->strip[placed->n_strips][1], to, 2 * sizeof *to);
        placed->strip_half[placed->n_strips++] = half;
    }
}

void hn_label_keep_off_corners(const hn_sheet *s, hn_label_places *placed) {
    const hn_box *box = &s->drawing;
    const double length = 2.2 * s->font, bar = 0.5 * s->scale * s->scale_bar;
    const double right = box->x + box->width - 1.6 * length, bottom = box->y + box->height;
    const double scale[2] = {box->x + bar, bottom - 0.8 * s->font};
    hn_label_remember(placed, HN_LABEL_SHEET, "", scale, bar);
    for (int k = -2; k <= 3 && s->in_space; k++) {
        const double xy[2] = {right, bottom - (1.1 + 0.5 * k) * length};
        hn_label_remember(placed, HN_LABEL_SHEET, "", xy, 1.6 * length);
    }
}

void hn_label_add_row(hn_label_places *placed, const char *text) {
    if (placed->n_rows < HN_LABEL_ROWS) {
        snprintf(placed->row[placed->n_rows++], HN_LABEL_TEXT, "%s", text);
    }
}

// ---- room ----

static double distance_to_segment(const double p[2], const double a[2], const double b[2]) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    const double share = square > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square : 0;
    const double t = fmin(1, fmax(0, share));
    return hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

/// The segment that a shape covers on the sheet [px].
void hn_label_segment_of(const hn_sheet *s, const hn_shape *shape, const double *points,
                         double a[2], double b[2]) {
    hn_sheet_pixel(s, points + 3 * shape->p, a);
    memcpy(b, a, 2 * sizeof *b);
    if (shape->kind == HN_SHAPE_GROUND) {
        b[1] += 1.6 * s->bar; // its triangle and hatching
    } else if (shape->kind == HN_SHAPE_BAR || shape->kind == HN_SHAPE_SPRING ||
               shape->kind == HN_SHAPE_DAMPER) {
        hn_sheet_pixel(s, points + 3 * shape->q, b);
    } else if (shape->kind == HN_SHAPE_SLIDER) {
        hn_sheet_pixel(s, points + 3 * shape->q, b);
        const double length = hypot(b[0] - a[0], b[1] - a[1]), half = 1.3 * s->bar; // its box
        const double u[2] = {length > 0 ? (b[0] - a[0]) / length : 1,
                             length > 0 ? (b[1] - a[1]) / length : 0};
        a[0] -= half * u[0];
        a[1] -= half * u[1];
        b[0] = a[0] + 2 * half * u[0];
        b[1] = a[1] + 2 * half * u[1];
    }
}

/// From a text of this half width around `xy` to the nearest of those placed before; none is in the
/// way from a line's height on.
static double room_beside(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                          double half) {
    double room = HUGE_VAL;
    for (int i = 0; i < placed->n; i++) {
        const double across =
            fabs(placed->at[i][0] - xy[0]) - placed->half[i] - half - APART * s->font;
        const double down = fabs(placed->at[i][1] - xy[1]) - s->font;
        const double clear = fmax(across, down);
        room = clear < 0 ? fmin(room, clear) : room;
    }
    return room;
}

/// From a line of text of this half width to a segment; below 0 the segment crosses the text.
double hn_label_room_to_line(const double xy[2], double half, double height, const double a[2],
                             const double b[2]) {
    enum { SAMPLES = 7 };
    double room = HUGE_VAL;
    for (int k = 0; k < SAMPLES; k++) {
        const double inner = fmax(half - 0.5 * height, 0);
        const double at[2] = {xy[0] + inner * (2.0 * k / (SAMPLES - 1) - 1), xy[1]};
        room = fmin(room, distance_to_segment(at, a, b) - 0.5 * height);
    }
    return room;
}

double hn_label_room(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                     double half) {
    double room = room_beside(s, placed, xy, half);
    for (int i = 0; i < placed->n_lines; i++) {
        const double(*line)[2] = placed->line[i];
        room = fmin(room, hn_label_room_to_line(xy, half, s->font, line[0], line[1]));
    }
    return room;
}

/// Returns how far a text lies inside the part of the sheet that is the drawing's; below 0: beyond
/// it.
double hn_label_room_on_sheet(const hn_sheet *s, const double xy[2], double half) {
    const hn_box *box = &s->drawing;
    const double tall = 0.6 * s->font;
    const double across = fmin(xy[0] - half - 2, box->x + box->width - xy[0] - half);
    return fmin(across, fmin(xy[1] - tall - box->y, s->height - 2 - xy[1] - tall));
}

// ---- free places ----

/// Returns whether the segment passes through a box (left, top, right, bottom), by the clipping of
/// Liang and Barsky.
static bool passes_box(const double box[4], const double a[2], const double b[2]) {
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    double first = 0, last = 1;
    for (int k = 0; k < 2; k++) {
        const double low = box[k] - a[k], high = box[k + 2] - a[k];
        if (d[k] == 0 && (low > 0 || high < 0)) {
            return false;
        }
        if (d[k] != 0) {
            first = fmax(first, fmin(low / d[k], high / d[k]));
            last = fmin(last, fmax(low / d[k], high / d[k]));
        }
    }
    return first < last;
}

static void box_of(const hn_sheet *s, const double xy[2], double half, double more, double box[4]) {
    const double tall = TALL * s->font;
    box[0] = xy[0] - half - more;
    box[1] = xy[1] - tall - more;
    box[2] = xy[0] + half + more;
    box[3] = xy[1] + tall + more;
}

bool hn_label_is_free(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                      double half) {
    double box[4];
    if (hn_label_room_on_sheet(s, xy, half) < 0 || room_beside(s, placed, xy, half) < 0) {
        return false;
    }
    for (int i = 0; i < placed->n_strips; i++) {
        box_of(s, xy, half, placed->strip_half[i], box);
        if (passes_box(box, placed->strip[i][0], placed->strip[i][1])) {
            return false;
        }
    }
    return true;
}

bool hn_label_is_on_line(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                         double half) {
    double box[4];
    box_of(s, xy, half, PAPER, box);
    for (int i = 0; i < placed->n_lines; i++) {
        if (passes_box(box, placed->line[i][0], placed->line[i][1])) {
            return true;
        }
    }
    return false;
}

bool hn_label_is_crossed(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                         const double end[2]) {
    double box[4];
    for (int i = 0; i < placed->n; i++) {
        box_of(s, placed->at[i], placed->half[i], 0, box);
        if (passes_box(box, xy, end)) {
            return true;
        }
    }
    return false;
}

// ---- room to the mechanism ----

/// Half of what a shape covers across its segment [px].
static double half_width_of(const hn_sheet *s, const hn_shape *shape) {
    const bool is_bar = shape->kind == HN_SHAPE_BAR && shape->width > 0;
    return 0.5 * (is_bar ? fmax(4, s->scale * shape->width) : s->bar);
}

/// The room to both rails of a guide, which cross the whole drawing.
static double room_beside_guide(const hn_sheet *s, const hn_shape *guide, const double *points,
                                const double xy[2], double half) {
    double a[2], b[2], room = HUGE_VAL;
    hn_sheet_pixel(s, points + 3 * guide->p, a);
    hn_sheet_pixel(s, points + 3 * guide->q, b);
    const double length = hypot(b[0] - a[0], b[1] - a[1]), far = s->width + s->height;
    if (!(length > 0)) {
        return room;
    }
    const double u[2] = {(b[0] - a[0]) / length, (b[1] - a[1]) / length};
    const double off = 2.04 * half_width_of(s, guide);
    for (int side = -1; side <= 1; side += 2) {
        const double x = a[0] - side * off * u[1], y = a[1] + side * off * u[0];
        const double from[2] = {x - far * u[0], y - far * u[1]};
        const double to[2] = {x + far * u[0], y + far * u[1]};
        room = fmin(room, hn_label_room_to_line(xy, half, s->font, from, to));
    }
    return room;
}

double hn_label_room_of_all(const hn_sheet *s, const hn_drawing *d, const double *points,
                            const hn_label_places *placed, const double xy[2], double half) {
    double room = hn_label_room(s, placed, xy, half), a[2], b[2];
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *shape = &d->shapes[i];
        if (shape->kind == HN_SHAPE_GUIDE) {
            room = fmin(room, room_beside_guide(s, shape, points, xy, half));
            continue;
        }
        hn_label_segment_of(s, shape, points, a, b);
        room = fmin(room, hn_label_room_to_line(xy, half, s->font, a, b) - half_width_of(s, shape));
        for (int k = 0; k < shape->n && shape->kind == HN_SHAPE_POLYGON; k++) {
            hn_sheet_pixel(s, points + 3 * (shape->p + k), a);
            hn_sheet_pixel(s, points + 3 * (shape->p + (k + 1) % shape->n), b);
            room = fmin(room, hn_label_room_to_line(xy, half, s->font, a, b));
        }
    }
    return fmin(room, hn_label_room_on_sheet(s, xy, half));
}

void hn_label_halo(hn_canvas *c, const hn_sheet *s, const double xy[2], double half) {
    const double tall = 0.55 * s->font, wide = half + 2;
    const double box[] = {xy[0] - wide, xy[1] - tall, xy[0] + wide, xy[1] - tall,
                          xy[0] + wide, xy[1] + tall, xy[0] - wide, xy[1] + tall};
    hn_canvas_polygon(c, box, 4, (hn_paint){hn_surface_get(hn_canvas_theme(c))->paper, HALO});
}

// ---- the list of texts ----

void hn_label_places_json(hn_strbuf *b, const hn_sheet *s, const hn_label_places *placed) {
    static const char *const kinds[HN_LABEL_KINDS] = {"name",  "force", "length",
                                                      "angle", "time",  "sheet"};
    double box[4];
    hn_json_key(b, "labels");
    hn_json_array(b);
    for (int i = 0; i < placed->n; i++) {
        box_of(s, placed->at[i], placed->half[i], 0, box);
        hn_json_object(b);
        hn_json_put_string(b, "text", placed->text[i]);
        hn_json_put_string(b, "kind", kinds[placed->kind[i]]);
        hn_json_put_numbers(b, "box", box, 4);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_key(b, "hatching");
    hn_json_array(b);
    for (int i = 0; i < placed->n_strips; i++) {
        hn_json_object(b);
        hn_json_put_numbers(b, "from", placed->strip[i][0], 2);
        hn_json_put_numbers(b, "to", placed->strip[i][1], 2);
        hn_json_put_number(b, "half", placed->strip_half[i]);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_key(b, "listed");
    hn_json_array(b);
    for (int i = 0; i < placed->n_rows; i++) {
        hn_json_string(b, placed->row[i]);
    }
    hn_json_end_array(b);
}
