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

/// An angle on the sheet [px, rad], counted clockwise as pixels are.
typedef struct arc {
    double pivot[2], radius;
    double from, to;
} arc;

/// False: the bar is too short in this view, or its angle is too small to be seen.
static bool lay_arc(const hn_sheet *s, const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                    int i, arc *out) {
    const hn_snapshot_angle *angle = &opts->angles[i];
    double end[2], other[2];
    hn_sheet_pixel(s, pose->points + 3 * angle->pivot, out->pivot);
    hn_sheet_pixel(s, pose->points + 3 * angle->end, end);
    const double across = end[0] - out->pivot[0], down = end[1] - out->pivot[1];
    const double length = hypot(across, down), value = fmod(angle->value, TURN);
    out->to = atan2(down, across);
    out->from = out->to + value;
    if (!(fabs(value) >= SMALLEST) || !(length > 1.5 * s->font)) {
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
    const double beyond = a->radius + BEYOND * s->font;
    const hn_stroke thin = hn_stroke_solid(ink, 0.7 * s->line);
    hn_stroke dashed = thin;
    dashed.dash = dash;
    dashed.n_dash = 2;
    hn_canvas_segment(c, a->pivot[0], a->pivot[1], a->pivot[0] + beyond * cos(a->from),
                      a->pivot[1] + beyond * sin(a->from), &dashed);

    // the arc ends in an arrow whose head is a chord of it
    const double sense = a->to > a->from ? 1 : -1;
    const double turn = fmin(head / a->radius, 0.9 * fabs(a->to - a->from));
    const double neck = a->to - sense * turn;
    hn_canvas_arc(c, a->pivot[0], a->pivot[1], a->radius, a->from, neck, &thin);
    hn_canvas_arrow(c, a->pivot[0] + a->radius * cos(neck), a->pivot[1] + a->radius * sin(neck),
                    a->pivot[0] + a->radius * cos(a->to), a->pivot[1] + a->radius * sin(a->to),
                    fmin(head, 0.9 * turn * a->radius), &thin);
}

/// Of places outside the arc and inside it, the one with the most room; returns that room [px].
static double place_text(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                         const arc *a, const hn_label_places *placed, double half, double out[2]) {
    static const double shares[] = {0.5, 0.35, 0.65, 0.2, 0.8, -0.2, 1.2};
    static const double rings[] = {0.75, 1.5, 2.4, -0.9};
    double most = -HUGE_VAL;
    for (size_t r = 0; r < sizeof rings / sizeof *rings; r++) {
        for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
            const double angle = a->from + shares[k] * (a->to - a->from);
            const double wider = half * fabs(cos(angle)) * (rings[r] < 0 ? -1 : 1);
            const double away = a->radius + rings[r] * s->font + wider;
            const double xy[2] = {a->pivot[0] + away * cos(angle), a->pivot[1] + away * sin(angle)};
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

/// Keeps texts off the arc, in chords, and off the dashed line before it.
static void keep_off(const hn_sheet *s, const arc *a, hn_label_places *placed) {
    enum { CHORDS = 4 };
    const double near = 0.5 * s->font, far = a->radius + BEYOND * s->font;
    const double dashed[2][2] = {
        {a->pivot[0] + near * cos(a->from), a->pivot[1] + near * sin(a->from)},
        {a->pivot[0] + far * cos(a->from), a->pivot[1] + far * sin(a->from)}};
    hn_label_keep_off_line(placed, dashed);
    const double step = (a->to - a->from) / CHORDS;
    for (int k = 0; k < CHORDS; k++) {
        const double from = a->from + step * k, to = from + step;
        const double line[2][2] = {
            {a->pivot[0] + a->radius * cos(from), a->pivot[1] + a->radius * sin(from)},
            {a->pivot[0] + a->radius * cos(to), a->pivot[1] + a->radius * sin(to)}};
        hn_label_keep_off_line(placed, line);
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
