// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_angles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double TURN = 2 * 3.14159265358979324;
static const double SMALLEST = 0.05;    // [rad] a smaller angle has no arc
static const double VALUE_SIZE = 0.85;  // letters, of the body text
static const double FIRST_RADIUS = 2.4; // [letters]
static const double SAME_PLACE = 2;     // [px]
static const double BEYOND = 0.8;       // [letters] that the dashed line is longer than the radius

static const double EDGE_ON = 0.25; // a circle seen narrower than this share has no arc
static const double CROSSED = 0.2;  // [letters] that a line may lie within a text at most
enum { ARC_POINTS = 49, MOST_ANGLES = 48 };

/// An angle on the sheet: part of a circle, which is an ellipse where it is seen at a slant.
typedef struct arc {
    double pivot[2], radius;    ///< [px]
    double zero[2], quarter[2]; ///< where directions of length 1 at 0 and pi/2 are seen [1]
    double to;                  ///< [rad] from 0, within a turn
} arc;

/// The point of the arc at an angle, or `beyond` [px] farther from the pivot.
static void arc_point(const arc *a, double angle, double beyond, double out[2]) {
    double seen[2];
    for (int k = 0; k < 2; k++) {
        seen[k] = a->zero[k] * cos(angle) + a->quarter[k] * sin(angle);
    }
    const double length = hypot(seen[0], seen[1]);
    for (int k = 0; k < 2; k++) {
        out[k] = a->pivot[k] + (a->radius + (length > 0 ? beyond / length : 0)) * seen[k];
    }
}

/// A direction as it is seen [px down and right].
static void see(const hn_sheet *s, const double world[3], double out[2]) {
    hn_view_project(&s->look, world, out);
    out[1] = -out[1];
}

/// False: the bar is too short in this view, its angle is too small to be seen, or the circle is
/// seen edge on.
static bool lay_arc(const hn_sheet *s, const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                    int i, arc *out) {
    const hn_snapshot_angle *angle = &opts->angles[i];
    double end[2], other[2];
    hn_sheet_pixel(s, pose->points + 3 * angle->pivot, out->pivot);
    hn_sheet_pixel(s, pose->points + 3 * angle->end, end);
    see(s, angle->zero, out->zero);
    see(s, angle->quarter, out->quarter);
    out->to = fmod(angle->value, TURN);
    const double length = hypot(end[0] - out->pivot[0], end[1] - out->pivot[1]);
    const double open = out->zero[0] * out->quarter[1] - out->zero[1] * out->quarter[0];
    if (!(fabs(out->to) >= SMALLEST) || !(length > 1.5 * s->font) || !(fabs(open) >= EDGE_ON)) {
        return false;
    }

    // angles at one place lie around each other
    out->radius = fmin(FIRST_RADIUS * s->font, 0.6 * length);
    for (int k = 0; k < i; k++) {
        hn_sheet_pixel(s, pose->points + 3 * opts->angles[k].pivot, other);
        const double apart = hypot(other[0] - out->pivot[0], other[1] - out->pivot[1]);
        out->radius += apart < SAME_PLACE ? 0.9 * s->font : 0;
    }
    return true;
}

static void draw_arc(hn_canvas *c, const hn_sheet *s, const arc *a) {
    const uint32_t ink = hn_surface_get(hn_canvas_theme(c))->muted;
    const double dash[2] = {0.4 * s->font, 0.3 * s->font}, head = 0.5 * s->font;
    const hn_stroke thin = hn_stroke_solid(ink, 0.7 * s->line);
    double xy[ARC_POINTS][2], far[2];
    hn_stroke dashed = thin;
    dashed.dash = dash;
    dashed.n_dash = 2;
    arc_point(a, 0, BEYOND * s->font, far);
    hn_canvas_segment(c, a->pivot[0], a->pivot[1], far[0], far[1], &dashed);

    // the arc ends in an arrow whose head is a chord of it
    const double turn = fmin(head / a->radius, 0.9 * fabs(a->to));
    const double neck = a->to - copysign(turn, a->to);
    for (int k = 0; k < ARC_POINTS; k++) {
        arc_point(a, neck * k / (ARC_POINTS - 1), 0, xy[k]);
    }
    hn_canvas_line(c, xy[0], ARC_POINTS, &thin);
    arc_point(a, a->to, 0, far);
    const double *from = xy[ARC_POINTS - 1];
    hn_canvas_arrow(c, from[0], from[1], far[0], far[1], fmin(head, 0.9 * turn * a->radius), &thin);
}

/// The arcs of a sheet, one for each angle that has one.
typedef struct arcs {
    int n, angle[MOST_ANGLES];
    arc at[MOST_ANGLES];
} arcs;

static double distance_to_arc(const arc *a, const double xy[2]) {
    double nearest = HUGE_VAL, p[2];
    for (int k = 0; k < ARC_POINTS; k += 4) {
        arc_point(a, a->to * k / (ARC_POINTS - 1), 0, p);
        nearest = fmin(nearest, hypot(p[0] - xy[0], p[1] - xy[1]));
    }
    return nearest;
}

/// Returns whether a text at `xy` seems to belong to another arc: it is nearer, or around the text.
static bool is_doubtful(const arcs *all, int own, const double xy[2]) {
    const double away = distance_to_arc(&all->at[own], xy);
    for (int i = 0; i < all->n; i++) {
        const arc *other = &all->at[i];
        const double to_pivot = hypot(xy[0] - other->pivot[0], xy[1] - other->pivot[1]);
        const double apart =
            hypot(other->pivot[0] - all->at[own].pivot[0], other->pivot[1] - all->at[own].pivot[1]);
        if (i != own && (distance_to_arc(other, xy) < away ||
                         (apart > SAME_PLACE && to_pivot < other->radius))) {
            return true;
        }
    }
    return false;
}

/// Takes the free place with the most room, outside the arc or inside it. Returns whether one is
/// free.
static bool place_text(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                       const arcs *all, int own, const hn_label_places *placed, double half,
                       double out[2]) {
    static const double shares[] = {0.5, 0.35, 0.65, 0.2, 0.8, -0.2, 1.2};
    static const double rings[] = {0.75, 1.5, 2.4, -0.9, 3.4};
    const arc *a = &all->at[own];
    double most = -HUGE_VAL;
    for (size_t r = 0; r < sizeof rings / sizeof *rings; r++) {
        for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
            double xy[2];
            arc_point(a, shares[k] * a->to, 0, xy);
            const double away = hypot(xy[0] - a->pivot[0], xy[1] - a->pivot[1]);
            const double level = away > 0 ? fabs(xy[0] - a->pivot[0]) / away : 0;
            const double wider = half * level * (rings[r] < 0 ? -1 : 1);
            arc_point(a, shares[k] * a->to, rings[r] * s->font + wider, xy);
            const double room = hn_label_room_of_all(s, d, pose->points, placed, xy, half);
            const double worth = fmin(room, 0.3 * s->font) - 0.02 * s->font * (double)(7 * r + k) -
                                 s->font * is_doubtful(all, own, xy);
            if (worth > most && room > -CROSSED * s->font &&
                hn_label_is_free(s, placed, xy, half)) {
                most = worth;
                memcpy(out, xy, sizeof xy);
            }
        }
    }
    return most > -HUGE_VAL;
}

/// Writes "th1 = 0.53 rad", and the whole turns beside it: "th1 = 2.22 rad + 2 turns".
static void write_value(const hn_snapshot_angle *angle, char text[HN_LABEL_TEXT]) {
    const double within = fmod(angle->value, TURN);
    const double turns = round((angle->value - within) / TURN);
    const int n = snprintf(text, HN_LABEL_TEXT, "%.40s = %.2f rad", angle->name, within);
    if (turns != 0 && n > 0 && n < HN_LABEL_TEXT) {
        snprintf(text + n, HN_LABEL_TEXT - (size_t)n, " %c %.0f turn%s", turns < 0 ? '-' : '+',
                 fabs(turns), fabs(turns) > 1 ? "s" : "");
    }
}

/// The texts of all arcs with values, or the names alone.
typedef struct texts {
    bool placed[MOST_ANGLES];
    double at[MOST_ANGLES][2];
    char text[MOST_ANGLES][HN_LABEL_TEXT];
} texts;

/// Finds places for the texts of all arcs; returns whether every text has one.
static bool place_texts(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                        const hn_snapshot_opts *opts, const arcs *all, bool with_values,
                        hn_label_places *placed, texts *out) {
    bool all_placed = true;
    for (int i = 0; i < all->n; i++) {
        const hn_snapshot_angle *angle = &opts->angles[all->angle[i]];
        if (with_values) {
            write_value(angle, out->text[i]);
        } else {
            snprintf(out->text[i], HN_LABEL_TEXT, "%.60s", angle->name);
        }
        const double half = 0.5 * hn_canvas_text_width(VALUE_SIZE * s->font, out->text[i]);
        out->placed[i] = place_text(s, d, pose, all, i, placed, half, out->at[i]);
        if (out->placed[i]) {
            hn_label_remember(placed, HN_LABEL_ANGLE, out->text[i], out->at[i], half);
        }
        all_placed = all_placed && out->placed[i];
    }
    return all_placed;
}

static void keep_off_line(hn_label_places *placed, const double from[2], const double to[2]) {
    const double line[2][2] = {{from[0], from[1]}, {to[0], to[1]}};
    hn_label_keep_off_line(placed, line);
}

/// Keeps texts off the arc, in chords, and off the dashed line before it.
static void keep_off(const hn_sheet *s, const arc *a, hn_label_places *placed) {
    enum { CHORDS = 4 };
    double from[2], to[2];
    arc_point(a, 0, 0.5 * s->font - a->radius * hypot(a->zero[0], a->zero[1]), from);
    arc_point(a, 0, BEYOND * s->font, to);
    keep_off_line(placed, from, to);
    for (int k = 0; k < CHORDS; k++) {
        arc_point(a, a->to * k / CHORDS, 0, from);
        arc_point(a, a->to * (k + 1) / CHORDS, 0, to);
        keep_off_line(placed, from, to);
    }
}

/// Adds the values of angles to the legend: of all, or of those without an arc.
static void list_values(const hn_snapshot_opts *opts, const arcs *all, bool every,
                        hn_label_places *placed) {
    for (int i = 0, k = 0; i < opts->n_angles; i++) {
        char row[HN_LABEL_TEXT];
        const bool has_arc = k < all->n && all->angle[k] == i;
        k += has_arc;
        if (every || !has_arc) {
            write_value(&opts->angles[i], row);
            const size_t used = strlen(row);
            snprintf(row + used, sizeof row - used, "%s", has_arc ? "" : ", no arc");
            hn_label_add_row(placed, row);
        }
    }
}

void hn_snapshot_angles(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed) {
    arcs all = {.n = 0};
    texts t;
    for (int i = 0; i < opts->n_angles && all.n < MOST_ANGLES; i++) {
        if (lay_arc(s, pose, opts, i, &all.at[all.n])) {
            all.angle[all.n] = i;
            draw_arc(c, s, &all.at[all.n]);
            keep_off(s, &all.at[all.n++], placed);
        }
    }

    // values for all, or the names alone and the values in the legend
    const int n = placed->n;
    const bool with_values = place_texts(s, d, pose, opts, &all, true, placed, &t);
    if (!with_values) {
        placed->n = n;
        place_texts(s, d, pose, opts, &all, false, placed, &t);
    }
    list_values(opts, &all, !with_values, placed);
    for (int i = 0; i < all.n; i++) {
        if (t.placed[i]) {
            hn_canvas_text(c, t.at[i][0], t.at[i][1] + 0.3 * s->font, VALUE_SIZE * s->font,
                           HN_ALIGN_CENTRE, hn_paint_solid(hn_surface_get(hn_canvas_theme(c))->ink),
                           t.text[i]);
        }
    }
}
