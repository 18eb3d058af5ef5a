// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_angles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 96 };
static const double TURN = 2 * 3.14159265358979324;
static const double SMALLEST = 0.05;    // [rad] a smaller angle has no arc
static const double VALUE_SIZE = 0.85;  // letters, of the body text
static const double FIRST_RADIUS = 2.4; // [letters]
static const double SAME_PLACE = 2;     // [px]
static const double BEYOND = 0.8;       // [letters] that the dashed line is longer than the radius

static const double EDGE_ON = 0.25; // a circle seen narrower than this share has no arc
enum { ARC_POINTS = 49 };

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

/// Takes the place with the most room, outside the arc or inside it; returns that room [px].
static double place_text(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                         const arc *a, const hn_label_places *placed, double half, double out[2]) {
    static const double shares[] = {0.5, 0.35, 0.65, 0.2, 0.8, -0.2, 1.2};
    static const double rings[] = {0.75, 1.5, 2.4, -0.9};
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
            const double worth = fmin(room, 0.3 * s->font) - 0.02 * s->font * (double)(7 * r + k);
            if (worth > most) {
                most = worth;
                memcpy(out, xy, sizeof xy);
            }
        }
    }
    return hn_label_room_of_all(s, d, pose->points, placed, out, half);
}

static void draw_text(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                      const hn_snapshot_pose *pose, const hn_snapshot_angle *angle, const arc *a,
                      hn_label_places *placed) {
    char text[TEXT];
    double xy[2], half = 0;
    for (int with_value = 1; with_value >= 0; with_value--) {
        if (with_value) {
            snprintf(text, sizeof text, "%s = %.2f rad", angle->name, angle->value);
        } else {
            snprintf(text, sizeof text, "%s", angle->name);
        }
        half = 0.5 * hn_canvas_text_width(VALUE_SIZE * s->font, text);
        if (place_text(s, d, pose, a, placed, half, xy) >= 0) {
            break;
        }
    }
    hn_canvas_text(c, xy[0], xy[1] + 0.3 * s->font, VALUE_SIZE * s->font, HN_ALIGN_CENTRE,
                   hn_paint_solid(hn_surface_get(hn_canvas_theme(c))->ink), text);
    hn_label_remember(placed, xy, half);
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

void hn_snapshot_angles(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed) {
    arc a;
    for (int i = 0; i < opts->n_angles; i++) {
        if (lay_arc(s, pose, opts, i, &a)) {
            draw_arc(c, s, &a);
            keep_off(s, &a, placed);
        }
    }
    for (int i = 0; i < opts->n_angles; i++) {
        if (lay_arc(s, pose, opts, i, &a)) {
            draw_text(c, s, d, pose, &opts->angles[i], &a, placed);
        }
    }
}
