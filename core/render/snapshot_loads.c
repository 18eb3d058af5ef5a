// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_loads.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LONGEST_LOAD = 0.20;  // of the view
static const double VALUE_SIZE = 0.9;     // letters of a force's value, of the body text
static const double BESIDE = 0.6;         // [letters] farther from its arrow a value has a leader
static const double DOUBT = 1.5;          // [px] of room that a place loses for each doubt_of() it
static const double CROSSED = 4;          // [px] of room that it loses on a line of another mark
static const double ENOUGH = 2;           // [px] of room: more is no better
static const double SHORTEST_ARROW = 1.0; // [letters] a shorter one is drawn with a dot,
static const double SHORT_ARROW = 1.3;    // [letters] as long as this,
static const double SHORT_DOT = 0.22;     // [letters] the radius of the dot
enum {
    MOST_VALUES = 10, // more arrows have numbers
    MOST_AWAY = 3     // and so have those of which more values stand away from their arrows
};

typedef struct arrows {
    int n;
    hn_load_mark *at;
} arrows;

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

double hn_load_scale(const hn_sheet *s, const hn_snapshot_opts *opts) {
    const double view = s->scale * fmax(s->view[1] - s->view[0], s->view[3] - s->view[2]);
    const double longest = hn_snapshot_longest_load(s, opts);
    return longest > 0 ? LONGEST_LOAD * view / longest : 0;
}

double hn_load_short_length(const hn_sheet *s) {
    return SHORT_ARROW * s->font;
}

/// Each arrow ends at its point, as long as its share of the largest. One that would begin off the
/// sheet begins at its point in place of ending there. One that would be too short to be seen is
/// longer, and marked. False: it has no length in this view.
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
    const double true_length = hn_load_scale(s, opts) * size;
    out->load = i;
    out->is_short = true_length < SHORTEST_ARROW * s->font;
    const double length = out->is_short ? hn_load_short_length(s) : true_length;
    const double by[2] = {length * seen[0] / size, -length * seen[1] / size};
    double at[2];
    hn_sheet_pixel(s, load->point < 0 ? load->place : pose->points + 3 * load->point, at);
    const double before[2] = {at[0] - by[0], at[1] - by[1]},
                 behind[2] = {at[0] + by[0], at[1] + by[1]};
    const bool turned =
        hn_label_room_on_sheet(s, before, 0) < 0 && hn_label_room_on_sheet(s, behind, 0) > 0;
    memcpy(out->tail, turned ? at : before, sizeof before);
    memcpy(out->tip, turned ? behind : at, sizeof behind);
    out->placed = true;
    return true;
}

/// Writes the text of an arrow: its value, or its number from 1 on.
static void write_text(const hn_sheet *s, const hn_snapshot_opts *opts, hn_load_mark *w,
                       int number) {
    const hn_snapshot_load *load = &opts->loads[w->load];
    const double whole = hypot(hypot(load->force[0], load->force[1]), load->force[2]);
    if (number > 0) {
        snprintf(w->value, sizeof w->value, "%d", number);
    } else {
        hn_si_format(whole, load->unit, 3, w->value);
    }
    w->half = 0.5 * hn_canvas_text_width(VALUE_SIZE * s->font, w->value);
}

/// The room of a place for the value of arrow `own`.
static double room_for_value(const hn_sheet *s, const hn_drawing *d, const double *points,
                             const arrows *all, int own, const hn_label_places *placed,
                             const double xy[2]) {
    const double half = all->at[own].half, tall = 1.1 * s->font;
    double room = hn_label_room_on_sheet(s, xy, half) < 0 ? -1000 : HUGE_VAL, a[2], b[2];
    for (int i = 0; i < d->n_shapes; i++) {
        hn_label_segment_of(s, &d->shapes[i], points, a, b);
        room = fmin(room, hn_label_room_to_line(xy, half, tall, a, b) - 0.5 * s->bar);
    }
    for (int i = 0; i < all->n; i++) {
        room = fmin(room, hn_label_room_to_line(xy, half, tall, all->at[i].tail, all->at[i].tip));
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
/// nearer, 1 where the mechanism lies between, and 3 where a text does.
static int doubt_of(const hn_sheet *s, const hn_drawing *d, const double *points, const arrows *all,
                    int own, const hn_label_places *placed, const double xy[2]) {
    const double half = all->at[own].half, tall = 1.1 * s->font;
    const double nearest =
        hn_label_room_to_line(xy, half, tall, all->at[own].tail, all->at[own].tip);
    bool taken = false, crossed = false;
    for (int i = 0; i < all->n; i++) {
        taken |= i != own && hn_label_room_to_line(xy, half, tall, all->at[i].tail,
                                                   all->at[i].tip) < nearest + 0.3 * s->font;
    }

    // the way to the arrow but for its end: an arrow may lie on a bar
    double end[2], a[2], b[2];
    nearest_on(&all->at[own], xy, end);
    const double way[2] = {xy[0] + 0.8 * (end[0] - xy[0]), xy[1] + 0.8 * (end[1] - xy[1])};
    for (int i = 0; i < d->n_shapes; i++) {
        hn_label_segment_of(s, &d->shapes[i], points, a, b);
        crossed |= do_cross(xy, way, a, b);
    }
    return taken + crossed + 3 * hn_label_is_crossed(s, placed, xy, end);
}

/// Takes, behind the tail or on either side of the arrow, the nearest free place with room enough
/// and no doubt whose value it is. Returns whether one is free.
static bool place_value(const hn_sheet *s, const hn_drawing *d, const double *points,
                        const arrows *all, int own, const hn_label_places *placed, double out[2]) {
    enum { ALONG = 5, SIDES = 3, RINGS = 7 };
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
                                 DOUBT * doubt_of(s, d, points, all, own, placed, xy) -
                                 CROSSED * hn_label_is_on_line(s, placed, xy, w->half);
            if ((side || back > 0) && worth > most && hn_label_is_free(s, placed, xy, w->half)) {
                most = worth;
                memcpy(out, xy, sizeof xy);
            }
        }
    }
    return most > -HUGE_VAL;
}

/// The line that ties a value to its arrow where it stands away from it.
static void draw_leader(hn_canvas *c, const hn_sheet *s, const hn_load_mark *w) {
    const double away = hn_label_room_to_line(w->text, w->half, 1.1 * s->font, w->tail, w->tip);
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
    hn_label_halo(c, s, w->text, w->half);
    hn_canvas_text(c, w->text[0], w->text[1] + 0.3 * s->font, VALUE_SIZE * s->font, HN_ALIGN_CENTRE,
                   hn_paint_solid(surface->ink), w->value);
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

/// Returns whether a text stands away from its arrow, or seems to belong to another one.
static bool is_away(const hn_sheet *s, const hn_drawing *d, const double *points, const arrows *all,
                    int own) {
    const hn_label_places nothing = {0};
    const hn_load_mark *w = &all->at[own];
    const double away = hn_label_room_to_line(w->text, w->half, 1.1 * s->font, w->tail, w->tip);
    return away > BESIDE * s->font || doubt_of(s, d, points, all, own, &nothing, w->text) > 0;
}

/// Finds a place for the text of every arrow; returns whether all of them have one, and few stand
/// away from their arrows.
static bool place_texts(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                        const hn_snapshot_opts *opts, hn_label_places *placed, arrows *all,
                        bool numbered) {
    int away = 0;
    bool all_placed = true;
    for (int i = 0; i < all->n; i++) {
        write_text(s, opts, &all->at[i], numbered ? i + 1 : 0);
    }
    for (int i = 0; i < all->n; i++) {
        hn_load_mark *w = &all->at[i];
        w->placed = place_value(s, d, pose->points, all, i, placed, w->text);
        if (w->placed) {
            double end[2];
            nearest_on(w, w->text, end);
            const double leader[2][2] = {{w->text[0], w->text[1]}, {end[0], end[1]}};
            hn_label_remember(placed, HN_LABEL_FORCE, w->value, w->text, w->half);
            hn_label_keep_off_line(placed, leader);
        }
        all_placed = all_placed && w->placed;
        away += w->placed && is_away(s, d, pose->points, all, i);
    }
    return all_placed && away <= MOST_AWAY;
}

/// Adds to the legend what the number of each arrow stands for: "1 O1 7.88 N".
static void list_numbers(const hn_sheet *s, const hn_snapshot_opts *opts, const arrows *all,
                         hn_label_places *placed) {
    for (int i = 0; i < all->n; i++) {
        const hn_snapshot_load *load = &opts->loads[all->at[i].load];
        hn_load_mark value = all->at[i];
        char row[HN_LABEL_TEXT];
        write_text(s, opts, &value, 0);
        snprintf(row, sizeof row, "%d %.40s%s%.40s", i + 1, load->name ? load->name : "",
                 load->name ? " " : "", value.value);
        hn_label_add_row(placed, row);
    }
}

/// Adds to the legend the forces that have no arrow: too small beside the largest, or along the
/// line of sight.
static void list_unseen(const hn_sheet *s, const hn_snapshot_opts *opts, const arrows *all,
                        hn_label_places *placed) {
    for (int i = 0, k = 0; i < opts->n_loads && all->n < HN_LABEL_ARROWS; i++) {
        hn_load_mark value = {.load = i};
        char row[HN_LABEL_TEXT];
        if (k < all->n && all->at[k].load == i) {
            k++;
        } else if (opts->loads[i].name) {
            write_text(s, opts, &value, 0);
            snprintf(row, sizeof row, "%.30s %.40s, no arrow", opts->loads[i].name, value.value);
            hn_label_add_row(placed, row);
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

    // values, or numbers if values have no room; without a legend there is none to explain these
    const int n = placed->n, n_lines = placed->n_lines;
    placed->numbered = !opts->bare && all.n > MOST_VALUES;
    if (!placed->numbered && !place_texts(s, d, pose, opts, placed, &all, false) && !opts->bare) {
        placed->numbered = true;
        placed->n = n;
        placed->n_lines = n_lines;
    }
    if (placed->numbered) {
        place_texts(s, d, pose, opts, placed, &all, true);
        list_numbers(s, opts, &all, placed);
    }
    list_unseen(s, opts, &all, placed);
    return all.n;
}

void hn_load_short_arrow(hn_canvas *c, const hn_sheet *s, const double tail[2],
                         const double tip[2]) {
    const uint32_t ink = hn_surface_get(hn_canvas_theme(c))->ink;
    const hn_stroke stroke = hn_stroke_solid(ink, 0.7 * s->line);
    hn_canvas_arrow(c, tail[0], tail[1], tip[0], tip[1], 0.55 * s->font, &stroke);
    hn_canvas_disc(c, tail[0], tail[1], SHORT_DOT * s->font, hn_paint_solid(ink));
}

void hn_snapshot_loads(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                       hn_label_places *placed) {
    const hn_stroke stroke = hn_stroke_solid(hn_surface_get(hn_canvas_theme(c))->ink, s->line);
    hn_load_mark marks[HN_LABEL_ARROWS];
    const int n = hn_load_marks_place(s, d, pose, opts, placed, marks);
    for (int i = 0; i < n; i++) {
        const hn_load_mark *w = &marks[i];
        if (w->is_short) {
            hn_load_short_arrow(c, s, w->tail, w->tip);
            placed->has_short = true;
        } else {
            hn_canvas_arrow(c, w->tail[0], w->tail[1], w->tip[0], w->tip[1], 0.8 * s->font,
                            &stroke);
        }
    }
    for (int i = 0; i < n; i++) {
        if (marks[i].placed) {
            draw_value(c, s, &marks[i]);
        }
    }
}
