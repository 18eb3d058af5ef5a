// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_lengths.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SHORTEST_DIMENSION = 3; // [letters] a shorter bar has no room for its length
static const double SAME_LENGTH = 1e-6;     // relative
static const double VALUE_SIZE = 0.85;      // letters, of the body text
enum {
    MOST_LENGTHS = 160,
    MOST_TEETH = 8 // equal bars of the ground: more are a curve in pieces
};

/// As many equal lengths or more are written once. In a plane, where bars do not cover each other,
/// each has its own sooner.
static int count_alike(const hn_sheet *s) {
    return s->in_space ? 3 : 5;
}

// ---- what has a length ----

/// The length of a bar, or of the ground between two supports; `count` of them are equal.
typedef struct measure {
    int ends[2], count;
    bool of_ground;
    double value; ///< [m]
} measure;

typedef struct lengths {
    int n;
    measure at[MOST_LENGTHS];
} lengths;

static void add_length(lengths *l, const double *points, int p, int q, bool of_ground) {
    const double *a = points + 3 * p, *b = points + 3 * q;
    for (int i = 0; i < l->n; i++) {
        const int *e = l->at[i].ends;
        if ((e[0] == p && e[1] == q) || (e[0] == q && e[1] == p)) {
            return;
        }
    }
    if (l->n < MOST_LENGTHS) {
        l->at[l->n++] =
            (measure){{p, q}, 1, of_ground, hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2])};
    }
}

/// Finds the two supports of a mechanism, between which the ground is its last link. False where
/// there are more or fewer, or a bar joins them.
static bool find_ground_link(const hn_drawing *d, int ends[2]) {
    int n = 0;
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *shape = &d->shapes[i];
        if (shape->kind == HN_SHAPE_GUIDE) {
            return false;
        }
        if (shape->kind == HN_SHAPE_GROUND && n++ < 2) {
            ends[n - 1] = shape->p;
        }
    }
    return n == 2;
}

static lengths list_lengths(const hn_drawing *d, const double *points) {
    lengths l = {0};
    int ends[2];
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *bar = &d->shapes[i];
        if (bar->kind == HN_SHAPE_BAR) {
            add_length(&l, points, bar->p, bar->q, bar->body == HN_GROUND);
        }
    }
    if (find_ground_link(d, ends)) {
        add_length(&l, points, ends[0], ends[1], false);
    }
    for (int i = 0; i < l.n; i++) {
        for (int k = 0; k < l.n; k++) {
            l.at[i].count +=
                k != i && fabs(l.at[k].value - l.at[i].value) <= SAME_LENGTH * l.at[i].value;
        }
    }
    return l;
}

/// Returns whether the bar is a piece of a curve of the ground, which has no length of its own.
static bool is_curve(const measure *at) {
    return at->of_ground && at->count > MOST_TEETH;
}

void hn_snapshot_choose_unit(hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                             const hn_snapshot_opts *opts) {
    double least = s->scale_bar, most = s->scale_bar;
    if (opts->dimensions) {
        const lengths l = list_lengths(d, pose->points);
        for (int i = 0; i < l.n; i++) {
            if (!is_curve(&l.at[i]) && l.at[i].value > 0) {
                least = fmin(least, l.at[i].value);
                most = fmax(most, l.at[i].value);
            }
        }
    }
    const bool in_metres = most >= 1 && least >= 0.1;
    const bool in_millimetres = most < 1000 && least >= 1e-4;
    s->unit = in_metres ? HN_UNIT_M : in_millimetres ? HN_UNIT_MM : HN_UNIT_ANY;
}

// ---- dimension lines ----

/// The middle of all points on the sheet: dimension lines lie on the other side of their bar.
static void middle_of(const hn_sheet *s, const hn_drawing *d, const double *points, double out[2]) {
    out[0] = out[1] = 0;
    for (int i = 0; i < d->n_points; i++) {
        double xy[2];
        hn_sheet_pixel(s, points + 3 * i, xy);
        out[0] += xy[0] / d->n_points;
        out[1] += xy[1] / d->n_points;
    }
}

/// A line with the text in the middle of it, on paper.
static void draw_value(hn_canvas *c, const hn_sheet *s, double x, double y, const char *text) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const double size = VALUE_SIZE * s->font, half = 0.5 * hn_canvas_text_width(size, text) + 3;
    const double box[] = {x - half, y - 0.65 * size, x + half, y - 0.65 * size,
                          x + half, y + 0.65 * size, x - half, y + 0.65 * size};
    hn_canvas_polygon(c, box, 4, hn_paint_solid(surface->paper));
    hn_canvas_text(c, x, y + 0.35 * size, size, HN_ALIGN_CENTRE, hn_paint_solid(surface->ink),
                   text);
}

/// Finds the place for a value on a dimension line: the middle, or the nearest to it that is free
/// and that no force and no other text crosses; the one with the most room where all are crossed.
/// Returns whether one is free.
static bool place_on_line(const hn_sheet *s, const hn_label_places *placed, const double middle[2],
                          const double along[2], double half, double out[2]) {
    static const double shares[] = {0, 0.15, -0.15, 0.3, -0.3};
    double most = -HUGE_VAL;
    for (size_t i = 0; i < sizeof shares / sizeof *shares && most < 0; i++) {
        const double at[2] = {middle[0] + shares[i] * along[0], middle[1] + shares[i] * along[1]};
        const double room = hn_label_room(s, placed, at, half);
        if (room > most && hn_label_is_free(s, placed, at, half)) {
            most = room;
            memcpy(out, at, sizeof at);
        }
    }
    return most > -HUGE_VAL;
}

/// A dimension line beside its bar [px].
typedef struct dimension {
    double side[2]; ///< unit vector from the bar to the line
    double off;     ///< from the bar to the line
    double line[2][2];
    double text[2], half; ///< of the value
    double worth;         ///< -HUGE_VAL: the value has no free place
} dimension;

/// Returns how much of a dimension line lies on texts and lines that were placed before, as a
/// share.
static double share_covered(const hn_sheet *s, double line[2][2], const hn_label_places *placed) {
    enum { SAMPLES = 9 };
    double covered = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const double t = (k + 0.5) / SAMPLES;
        const double xy[2] = {line[0][0] + t * (line[1][0] - line[0][0]),
                              line[0][1] + t * (line[1][1] - line[0][1])};
        covered += (hn_label_room(s, placed, xy, 0) < 0) / (double)SAMPLES;
    }
    return covered;
}

/// Lays the line on the outer side of the bar, or, where other lines or the mechanism lie there, on
/// the inner one or farther away.
static dimension lay_dimension(const hn_sheet *s, const hn_drawing *d, const double *points,
                               const double a[2], const double b[2], const double middle[2],
                               double half, const hn_label_places *placed) {
    enum { TIERS = 4 };
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    const double u[2] = {(b[0] - a[0]) / length, (b[1] - a[1]) / length};
    const double along[2] = {b[0] - a[0], b[1] - a[1]};
    double outer[2] = {-u[1], u[0]};
    if (outer[0] * (a[0] + b[0] - 2 * middle[0]) + outer[1] * (a[1] + b[1] - 2 * middle[1]) < 0) {
        outer[0] = -outer[0];
        outer[1] = -outer[1];
    }
    dimension out = {.worth = -HUGE_VAL};
    for (int k = 0; k < 2 * TIERS; k++) {
        const double sign = k % 2 ? -1 : 1, off = 1.1 * s->bar + (1.1 + 1.3 * (k / 2)) * s->font;
        dimension at = {.side = {sign * outer[0], sign * outer[1]}, .off = off};
        for (int i = 0; i < 2; i++) {
            at.line[0][i] = a[i] + off * at.side[i];
            at.line[1][i] = b[i] + off * at.side[i];
        }
        const double text[2] = {(at.line[0][0] + at.line[1][0]) / 2,
                                (at.line[0][1] + at.line[1][1]) / 2};
        if (!place_on_line(s, placed, text, along, half, at.text)) {
            continue;
        }
        const double room = hn_label_room_of_all(s, d, points, placed, at.text, half);
        at.worth = fmin(room, 0.3 * s->font) - s->font * (1.5 * share_covered(s, at.line, placed) +
                                                          0.3 * (k / 2) + 0.2 * (k % 2));
        at.half = half;
        out = at.worth > out.worth ? at : out;
    }
    return out;
}

static void draw_dimension(hn_canvas *c, const hn_sheet *s, const double a[2], const double b[2],
                           const dimension *at, const char *text, hn_label_places *placed) {
    // extension lines from the bar to a little beyond the dimension line
    const double off = at->off, gap = 0.7 * s->bar, beyond = 0.35 * s->font;
    const double *side = at->side;
    const hn_stroke thin =
        hn_stroke_solid(hn_surface_get(hn_canvas_theme(c))->muted, 0.6 * s->line);
    const double *const ends[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        const double *e = ends[i];
        hn_canvas_segment(c, e[0] + gap * side[0], e[1] + gap * side[1],
                          e[0] + (off + beyond) * side[0], e[1] + (off + beyond) * side[1], &thin);
        const double line[2][2] = {
            {e[0] + gap * side[0], e[1] + gap * side[1]},
            {e[0] + (off + beyond) * side[0], e[1] + (off + beyond) * side[1]}};
        hn_label_keep_off_line(placed, line);
    }

    // arrows from the middle to both ends, and the value on them
    const double middle_at[2] = {(a[0] + b[0]) / 2 + off * side[0],
                                 (a[1] + b[1]) / 2 + off * side[1]};
    for (int i = 0; i < 2; i++) {
        hn_canvas_arrow(c, middle_at[0], middle_at[1], at->line[i][0], at->line[i][1],
                        0.6 * s->font, &thin);
    }
    draw_value(c, s, at->text[0], at->text[1], text);
    hn_label_remember(placed, HN_LABEL_LENGTH, text, at->text, at->half);
    hn_label_keep_off_line(placed, at->line);
}

// ---- the whole ----

/// What lengths are drawn with.
typedef struct writer {
    hn_canvas *c;
    const hn_sheet *s;
    const hn_drawing *d;
    const double *points;
    hn_label_places *placed;
    double middle[2]; ///< of all points
} writer;

/// Returns whether the length is long enough on the sheet for a dimension line.
static bool is_seen(const writer *w, const measure *l, double a[2], double b[2]) {
    hn_sheet_pixel(w->s, w->points + 3 * l->ends[0], a);
    hn_sheet_pixel(w->s, w->points + 3 * l->ends[1], b);
    return hypot(b[0] - a[0], b[1] - a[1]) >= SHORTEST_DIMENSION * w->s->font;
}

static void write_length(const writer *w, const measure *l, char text[HN_LABEL_TEXT]) {
    char value[HN_SI_TEXT];
    hn_sheet_length(w->s, l->value, 3, value);
    if (l->count >= count_alike(w->s)) {
        snprintf(text, HN_LABEL_TEXT, "%d \xc3\x97 %s", l->count, value);
    } else {
        snprintf(text, HN_LABEL_TEXT, "%s", value);
    }
}

static dimension lay_length(const writer *w, const measure *l) {
    char text[HN_LABEL_TEXT];
    double a[2], b[2];
    if (!is_seen(w, l, a, b)) {
        return (dimension){.worth = -HUGE_VAL};
    }
    write_length(w, l, text);
    const double half = 0.5 * hn_canvas_text_width(VALUE_SIZE * w->s->font, text);
    return lay_dimension(w->s, w->d, w->points, a, b, w->middle, half, w->placed);
}

/// Draws length `i`, or the one of its equals that has the best place.
static void draw_length(const writer *w, const lengths *l, int i) {
    const measure *best = &l->at[i];
    dimension at = lay_length(w, best);
    bool seen = false;
    char text[HN_LABEL_TEXT], row[HN_LABEL_TEXT];
    double a[2], b[2];
    for (int k = i + 1; k < l->n && best->count >= count_alike(w->s); k++) {
        if (fabs(l->at[k].value - l->at[i].value) <= SAME_LENGTH * l->at[i].value) {
            const dimension other = lay_length(w, &l->at[k]);
            best = other.worth > at.worth ? &l->at[k] : best;
            at = other.worth > at.worth ? other : at;
        }
    }
    seen = is_seen(w, best, a, b);
    write_length(w, best, text);
    if (at.worth > -HUGE_VAL) {
        draw_dimension(w->c, w->s, a, b, &at, text, w->placed);
    } else if (seen || best->count >= count_alike(w->s)) {
        const char *from = w->d->labels[best->ends[0]], *to = w->d->labels[best->ends[1]];
        snprintf(row, sizeof row, "%.30s%s%.30s%s%.30s", from && to ? from : "length",
                 from && to ? " to " : "", from && to ? to : "", " ", text);
        hn_label_add_row(w->placed, row);
    }
}

void hn_snapshot_lengths(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                         const hn_snapshot_pose *pose, hn_label_places *placed) {
    writer w = {.c = c, .s = s, .d = d, .points = pose->points, .placed = placed};
    const lengths l = list_lengths(d, pose->points);
    middle_of(s, d, pose->points, w.middle);
    for (int i = 0; i < l.n; i++) {
        bool is_first = !is_curve(&l.at[i]);
        for (int k = 0; k < i && l.at[i].count >= count_alike(s); k++) {
            is_first =
                is_first && fabs(l.at[k].value - l.at[i].value) > SAME_LENGTH * l.at[i].value;
        }
        if (is_first) {
            draw_length(&w, &l, i);
        }
    }
}
