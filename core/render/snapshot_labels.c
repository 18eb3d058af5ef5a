// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_labels.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_TEXT = 96 };
static const double LONGEST_LOAD = 0.20; // of the view
static const double SAME_PLACE = 2;      // [px]
static const double VALUE_SIZE = 0.9;    // letters of a force's value, of the body text
static const double HALO = 0.8;          // how far the paper behind a text covers what is there
static const double BESIDE = 0.6;        // [letters] farther from its arrow a value has a leader
static const double DOUBT = 1.5;         // [px] of room that a place loses for each doubt_of() it
static const double ENOUGH = 2;          // [px] of room: more is no better

typedef struct arrows {
    int n;
    hn_load_mark *at;
} arrows;

void hn_label_remember(hn_label_places *placed, const double xy[2], double half) {
    if (placed->n < HN_LABELS_PLACED) {
        memcpy(placed->at[placed->n], xy, 2 * sizeof *xy);
        placed->half[placed->n++] = half;
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
static void segment_of(const hn_sheet *s, const hn_shape *shape, const double *points, double a[2],
                       double b[2]) {
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
        const double across = fabs(placed->at[i][0] - xy[0]) - placed->half[i] - half;
        const double down = fabs(placed->at[i][1] - xy[1]) - s->font;
        const double clear = fmax(across, down);
        room = clear < 0 ? fmin(room, clear) : room;
    }
    return room;
}

/// From a line of text of this half width to a segment; below 0 the segment crosses the text.
static double room_of_text(const double xy[2], double half, double height, const double a[2],
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
        room = fmin(room, room_of_text(xy, half, s->font, line[0], line[1]));
    }
    return room;
}

/// Returns how far a text lies inside the part of the sheet that is the drawing's; below 0: beyond
/// it.
static double room_on_sheet(const hn_sheet *s, const double xy[2], double half) {
    const hn_box *box = &s->drawing;
    const double tall = 0.6 * s->font;
    const double across = fmin(xy[0] - half - 2, box->x + box->width - xy[0] - half);
    return fmin(across, fmin(xy[1] - tall - box->y, s->height - 2 - xy[1] - tall));
}

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
        room = fmin(room, room_of_text(xy, half, s->font, from, to));
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
        segment_of(s, shape, points, a, b);
        room = fmin(room, room_of_text(xy, half, s->font, a, b) - half_width_of(s, shape));
        for (int k = 0; k < shape->n && shape->kind == HN_SHAPE_POLYGON; k++) {
            hn_sheet_pixel(s, points + 3 * (shape->p + k), a);
            hn_sheet_pixel(s, points + 3 * (shape->p + (k + 1) % shape->n), b);
            room = fmin(room, room_of_text(xy, half, s->font, a, b));
        }
    }
    return fmin(room, room_on_sheet(s, xy, half));
}

// ---- arrows ----

static double seen_size(const hn_sheet *s, const hn_snapshot_load *load, double seen[2]) {
    hn_view_project(&s->look, load->force, seen);
    return hypot(seen[0], seen[1]);
}

double hn_snapshot_longest_load(const hn_sheet *s, const hn_snapshot_opts *opts) {
    double longest = opts->longest_load, seen[2];
    for (int k = 0; k < opts->n_loads; k++) {
        longest = fmax(longest, seen_size(s, &opts->loads[k], seen));
    }
    return longest;
}

/// Each arrow ends at its point, as long as its share of the largest, and no shorter than its head.
/// One that would begin off the sheet begins at its point in place of ending there. False: it has
/// no length in this view.
static bool lay_arrow(const hn_sheet *s, const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                      int i, hn_load_mark *out) {
    const hn_snapshot_load *load = &opts->loads[i];
    double largest = 0, seen[2];
    for (int k = 0; k < opts->n_loads; k++) {
        largest = fmax(largest, seen_size(s, &opts->loads[k], seen));
    }
    const double size = seen_size(s, load, seen);
    if (!(size > 1e-3 * largest) || !isfinite(size)) {
        return false;
    }

    // from the tail to the tip
    const double view = s->scale * fmax(s->view[1] - s->view[0], s->view[3] - s->view[2]);
    const double longest = hn_snapshot_longest_load(s, opts);
    const double length = fmax(1.5 * s->font, LONGEST_LOAD * view * size / longest);
    const double by[2] = {length * seen[0] / size, -length * seen[1] / size};
    double at[2];
    hn_sheet_pixel(s, load->point < 0 ? load->place : pose->points + 3 * load->point, at);
    const double before[2] = {at[0] - by[0], at[1] - by[1]},
                 behind[2] = {at[0] + by[0], at[1] + by[1]};
    const bool turned = room_on_sheet(s, before, 0) < 0 && room_on_sheet(s, behind, 0) > 0;
    memcpy(out->tail, turned ? at : before, sizeof before);
    memcpy(out->tip, turned ? behind : at, sizeof behind);
    const double whole = hypot(hypot(load->force[0], load->force[1]), load->force[2]);
    hn_si_format(whole, load->unit, 3, out->value);
    out->half = 0.5 * hn_canvas_text_width(VALUE_SIZE * s->font, out->value);
    return true;
}

/// The room of a place for the value of arrow `own`.
static double room_for_value(const hn_sheet *s, const hn_drawing *d, const double *points,
                             const arrows *all, int own, const hn_label_places *placed,
                             const double xy[2]) {
    const double half = all->at[own].half, tall = 1.1 * s->font;
    double room = room_on_sheet(s, xy, half) < 0 ? -1000 : HUGE_VAL, a[2], b[2];
    for (int i = 0; i < d->n_shapes; i++) {
        segment_of(s, &d->shapes[i], points, a, b);
        room = fmin(room, room_of_text(xy, half, tall, a, b) - 0.5 * s->bar);
    }
    for (int i = 0; i < all->n; i++) {
        room = fmin(room, room_of_text(xy, half, tall, all->at[i].tail, all->at[i].tip));
    }
    return fmin(room, hn_label_room(s, placed, xy, half));
}

/// The point of an arrow that is nearest to a text.
static void nearest_on(const hn_load_mark *w, const double xy[2], double out[2]) {
    const double dx = w->tip[0] - w->tail[0], dy = w->tip[1] - w->tail[1];
    const double along = (xy[0] - w->tail[0]) * dx + (xy[1] - w->tail[1]) * dy;
    const double t = fmin(1, fmax(0, along / (dx * dx + dy * dy)));
    out[0] = w->tail[0] + t * dx;
    out[1] = w->tail[1] + t * dy;
}

/// On which side of the line from a to b a point lies: positive, negative or 0.
static double side_of(const double a[2], const double b[2], const double p[2]) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

static bool do_cross(const double a[2], const double b[2], const double p[2], const double q[2]) {
    return side_of(a, b, p) * side_of(a, b, q) < 0 && side_of(p, q, a) * side_of(p, q, b) < 0;
}

/// Returns how doubtful it is that a value at `xy` belongs to its arrow: 1 where another arrow is
/// nearer, and 1 where the mechanism lies between.
static int doubt_of(const hn_sheet *s, const hn_drawing *d, const double *points, const arrows *all,
                    int own, const double xy[2]) {
    const double half = all->at[own].half, tall = 1.1 * s->font;
    const double nearest = room_of_text(xy, half, tall, all->at[own].tail, all->at[own].tip);
    bool taken = false, crossed = false;
    for (int i = 0; i < all->n; i++) {
        taken |= i != own && room_of_text(xy, half, tall, all->at[i].tail, all->at[i].tip) <
                                 nearest + 0.3 * s->font;
    }

    // the way to the arrow but for its end: an arrow may lie on a bar
    double end[2], a[2], b[2];
    nearest_on(&all->at[own], xy, end);
    const double way[2] = {xy[0] + 0.8 * (end[0] - xy[0]), xy[1] + 0.8 * (end[1] - xy[1])};
    for (int i = 0; i < d->n_shapes; i++) {
        segment_of(s, &d->shapes[i], points, a, b);
        crossed |= do_cross(xy, way, a, b);
    }
    return taken + crossed;
}

/// Takes, behind the tail or on either side of the arrow, the nearest place with room enough and no
/// doubt whose value it is; the best where none is.
static void place_value(const hn_sheet *s, const hn_drawing *d, const double *points,
                        const arrows *all, int own, const hn_label_places *placed, double out[2]) {
    enum { ALONG = 5, SIDES = 3, RINGS = 4 };
    const hn_load_mark *w = &all->at[own];
    const double length = hypot(w->tip[0] - w->tail[0], w->tip[1] - w->tail[1]);
    const double u[2] = {(w->tip[0] - w->tail[0]) / length, (w->tip[1] - w->tail[1]) / length};
    double most = -HUGE_VAL;
    for (int ring = 0; ring < RINGS; ring++) {
        for (int k = 0; k < ALONG * SIDES; k++) {
            // from behind the tail towards the tip; on the line, left, right
            const int side = (k % SIDES + 1) / 2 * (k % SIDES == 1 ? 1 : -1);
            const double t = k / SIDES == 0 ? 0 : length * (k / SIDES - 1) / (ALONG - 1);
            const double off = (0.8 + 1.1 * ring) * s->font, n[2] = {-u[1] * side, u[0] * side};
            const double wide = w->half + (0.3 + 1.1 * ring) * s->font;
            const double back = k / SIDES == 0 ? 1 : 0;
            const double xy[2] = {w->tail[0] + t * u[0] + wide * (n[0] - back * u[0]),
                                  w->tail[1] + t * u[1] + off * (n[1] - back * u[1])};
            const double room = room_for_value(s, d, points, all, own, placed, xy);
            const double worth = fmin(room, ENOUGH) - 0.02 * (ring * ALONG * SIDES + k) -
                                 DOUBT * doubt_of(s, d, points, all, own, xy);
            if ((side || back > 0) && worth > most) {
                most = worth;
                memcpy(out, xy, sizeof xy);
            }
        }
    }
}

/// Paper behind a line of text.
static void draw_halo(hn_canvas *c, const hn_sheet *s, const double xy[2], double half) {
    const double tall = 0.55 * s->font, wide = half + 2;
    const double box[] = {xy[0] - wide, xy[1] - tall, xy[0] + wide, xy[1] - tall,
                          xy[0] + wide, xy[1] + tall, xy[0] - wide, xy[1] + tall};
    hn_canvas_polygon(c, box, 4, (hn_paint){hn_surface_get(hn_canvas_theme(c))->paper, HALO});
}

/// The line that ties a value to its arrow where it stands away from it.
static void draw_leader(hn_canvas *c, const hn_sheet *s, const hn_load_mark *w) {
    const double away = room_of_text(w->text, w->half, 1.1 * s->font, w->tail, w->tip);
    const hn_stroke thin =
        hn_stroke_solid(hn_surface_get(hn_canvas_theme(c))->muted, 0.5 * s->line);
    double end[2];
    if (away > BESIDE * s->font) {
        nearest_on(w, w->text, end);
        hn_canvas_segment(c, w->text[0], w->text[1], end[0], end[1], &thin);
    }
}

static void draw_value(hn_canvas *c, const hn_sheet *s, const hn_load_mark *w) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    draw_leader(c, s, w);
    draw_halo(c, s, w->text, w->half);
    hn_canvas_text(c, w->text[0], w->text[1] + 0.3 * s->font, VALUE_SIZE * s->font, HN_ALIGN_CENTRE,
                   hn_paint_solid(surface->ink), w->value);
}

/// Keeps values off the triad of axes and the scale bar, which the sheet draws later.
static void remember_corners(const hn_sheet *s, hn_label_places *placed) {
    const hn_box *box = &s->drawing;
    const double length = 2.2 * s->font, bar = 0.5 * s->scale * s->scale_bar;
    const double right = box->x + box->width - 1.6 * length, bottom = box->y + box->height;
    const double scale[2] = {box->x + bar, bottom - 0.8 * s->font};
    hn_label_remember(placed, scale, bar);
    for (int k = -2; k <= 2 && s->in_space; k++) {
        const double xy[2] = {right, bottom - (1.1 + 0.5 * k) * length};
        hn_label_remember(placed, xy, 1.9 * length);
    }
}

void hn_label_keep_off_line(hn_label_places *placed, const double line[2][2]) {
    if (placed->n_lines < (int)(sizeof placed->line / sizeof *placed->line)) {
        memcpy(placed->line[placed->n_lines++], line, sizeof *placed->line);
    }
}

void hn_label_keep_off_loads(const hn_sheet *s, const hn_snapshot_pose *pose,
                             const hn_snapshot_opts *opts, hn_label_places *placed) {
    hn_load_mark w;
    for (int i = 0, n = 0; i < opts->n_loads && n < HN_LABEL_ARROWS; i++) {
        if (lay_arrow(s, pose, opts, i, &w)) {
            const double line[2][2] = {{w.tail[0], w.tail[1]}, {w.tip[0], w.tip[1]}};
            hn_label_keep_off_line(placed, line);
            n++;
        }
    }
}

int hn_load_marks_place(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                        const hn_snapshot_opts *opts, hn_label_places *placed,
                        hn_load_mark out[HN_LABEL_ARROWS]) {
    arrows all = {.at = out};
    for (int i = 0; i < opts->n_loads && all.n < HN_LABEL_ARROWS; i++) {
        all.n += lay_arrow(s, pose, opts, i, &out[all.n]);
    }
    if (all.n > 0) {
        remember_corners(s, placed);
    }
    for (int i = 0; i < all.n; i++) {
        place_value(s, d, pose->points, &all, i, placed, out[i].text);
        hn_label_remember(placed, out[i].text, out[i].half);
    }
    return all.n;
}

static void draw_loads(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                       hn_label_places *placed) {
    const hn_stroke stroke = hn_stroke_solid(hn_surface_get(hn_canvas_theme(c))->ink, s->line);
    hn_load_mark marks[HN_LABEL_ARROWS];
    const int n = hn_load_marks_place(s, d, pose, opts, placed, marks);
    for (int i = 0; i < n; i++) {
        const hn_load_mark *w = &marks[i];
        hn_canvas_arrow(c, w->tail[0], w->tail[1], w->tip[0], w->tip[1], 0.8 * s->font, &stroke);
    }
    for (int i = 0; i < n; i++) {
        draw_value(c, s, &marks[i]);
    }
}

// ---- names ----

/// Takes the nearest of sixteen places around a point with room enough; the
/// one with the most room where none has.
static void place_label(const hn_sheet *s, const hn_drawing *d, const double *points, int point,
                        const hn_label_places *placed, double half, double out[2]) {
    enum { PLACES = 16, RINGS = 4 };
    const double wider = fmax(0, half - 0.5 * s->font); // a long text begins where a short one does
    const double enough = 0.45 * s->font, step = 0.45 * s->font;
    double xy[2], most = -HUGE_VAL;
    hn_sheet_pixel(s, points + 3 * point, xy);
    for (int k = 0; k < PLACES * RINGS; k++) {
        const double angle = 2 * 3.14159265358979324 * (k % PLACES) / PLACES;
        const double off = 0.75 * s->bar + 0.85 * s->font + step * (k / PLACES);
        const double place[2] = {xy[0] + (off + wider) * cos(angle), xy[1] - off * sin(angle)};
        const double room = hn_label_room_of_all(s, d, points, placed, place, half);
        const double worth = fmin(room, enough) - 0.25 * step * (k / PLACES);
        if (worth > most + 0.5) {
            most = worth;
            memcpy(out, place, sizeof place);
        }
    }
}

/// The names of all points that are seen where point `first` is, "B1 A2"; 0: an earlier one has
/// told them.
static bool names_at(const hn_sheet *s, const hn_drawing *d, const double *points, int first,
                     char text[LABEL_TEXT]) {
    double here[2], there[2];
    size_t used = 0;
    hn_sheet_pixel(s, points + 3 * first, here);
    for (int i = 0; i < d->n_points; i++) {
        hn_sheet_pixel(s, points + 3 * i, there);
        if (d->labels[i] == NULL || hypot(there[0] - here[0], there[1] - here[1]) > SAME_PLACE) {
            continue;
        }
        if (i < first) {
            return false;
        }
        const int n = snprintf(text + used, LABEL_TEXT - used, used ? " %s" : "%s", d->labels[i]);
        used = n > 0 && used + (size_t)n < LABEL_TEXT ? used + (size_t)n : LABEL_TEXT - 1;
    }
    return true;
}

static void draw_names(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *pose, bool halo, hn_label_places *placed) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    for (int i = 0; i < d->n_points; i++) {
        char text[LABEL_TEXT];
        double xy[2];
        if (d->labels[i] == NULL || !names_at(s, d, pose->points, i, text)) {
            continue;
        }
        const double half = 0.5 * hn_canvas_text_width(s->font, text);
        place_label(s, d, pose->points, i, placed, half, xy);
        if (halo) {
            draw_halo(c, s, xy, half);
        }
        hn_canvas_text(c, xy[0], xy[1] + 0.35 * s->font, s->font, HN_ALIGN_CENTRE,
                       hn_paint_solid(surface->ink), text);
        hn_label_remember(placed, xy, half);
    }
}

void hn_snapshot_labels(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed) {
    draw_loads(c, s, d, pose, opts, placed); // names keep off the values of forces
    if (opts->labels) {
        draw_names(c, s, d, pose, opts->dimensions, placed); // over the lines of the dimensions
    }
}
