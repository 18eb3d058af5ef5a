// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_marks.h"

#include "base/units.h"
#include "render/snapshot_labels.h"

#include <math.h>
#include <string.h>

static const double SHORTEST_DIMENSION = 3; // [letters] a shorter bar has no room for its length

/// The bar that is longest on the sheet, NULL when there is none.
static const hn_shape *longest_bar(const hn_sheet *s, const hn_drawing *d, const double *points) {
    const hn_shape *longest = NULL;
    double most = 0;
    for (int i = 0; i < d->n_shapes; i++) {
        double a[2], b[2];
        if (d->shapes[i].kind == HN_SHAPE_BAR) {
            hn_sheet_pixel(s, points + 3 * d->shapes[i].p, a);
            hn_sheet_pixel(s, points + 3 * d->shapes[i].q, b);
            const double length = hypot(b[0] - a[0], b[1] - a[1]);
            longest = length > most ? &d->shapes[i] : longest;
            most = fmax(most, length);
        }
    }
    return longest;
}

static int count_listed(const hn_snapshot_pose *poses, int n_poses) {
    int n = 0;
    for (int i = 0; i < n_poses; i++) {
        n += !poses[i].faint;
    }
    return n;
}

void hn_snapshot_markers(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                         const hn_snapshot_pose *poses, int n_poses) {
    const hn_shape *bar = longest_bar(s, d, poses[s->selected].points);
    const hn_theme theme = hn_canvas_theme(c);
    const int n = count_listed(poses, n_poses);
    if (!bar || n < 2) {
        return;
    }
    for (int i = 0, k = 0; i < n_poses; i++) {
        if (poses[i].faint || !hn_pose_is_drawable(d, &poses[i])) {
            k += !poses[i].faint;
            continue;
        }

        // poses may coincide: every method has a share of the bar of its own
        double a[2], b[2];
        const double share = ++k / (n + 1.0);
        hn_sheet_pixel(s, poses[i].points + 3 * bar->p, a);
        hn_sheet_pixel(s, poses[i].points + 3 * bar->q, b);
        const double x = a[0] + share * (b[0] - a[0]), y = a[1] + share * (b[1] - a[1]);
        hn_canvas_disc(c, x, y, 0.5 * s->font, hn_paint_solid(hn_surface_get(theme)->paper));
        hn_canvas_marker(c, hn_look_get(poses[i].slot)->marker, x, y, 0.7 * s->font,
                         hn_paint_solid(hn_look_get(poses[i].slot)->colour[theme]));
    }
}

// ---- dimension lines ----

/// 1 when an earlier bar joins the same two points.
static bool is_repeated(const hn_drawing *d, int shape) {
    const hn_shape *bar = &d->shapes[shape];
    for (int i = 0; i < shape; i++) {
        const hn_shape *other = &d->shapes[i];
        if (other->kind == HN_SHAPE_BAR && ((other->p == bar->p && other->q == bar->q) ||
                                            (other->p == bar->q && other->q == bar->p))) {
            return true;
        }
    }
    return false;
}

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
    const double size = 0.85 * s->font, half = 0.5 * hn_canvas_text_width(size, text) + 3;
    const double box[] = {x - half, y - 0.65 * size, x + half, y - 0.65 * size,
                          x + half, y + 0.65 * size, x - half, y + 0.65 * size};
    hn_canvas_polygon(c, box, 4, hn_paint_solid(surface->paper));
    hn_canvas_text(c, x, y + 0.35 * size, size, HN_ALIGN_CENTRE, hn_paint_solid(surface->ink),
                   text);
}

/// The place for a value on a dimension line: the middle, or the nearest to it that no force and no
/// other text crosses; the one with the most room where all are crossed.
static void place_on_line(const hn_sheet *s, const hn_label_places *placed, const double middle[2],
                          const double along[2], double half, double out[2]) {
    static const double shares[] = {0, 0.15, -0.15, 0.3, -0.3};
    double most = -HUGE_VAL;
    for (size_t i = 0; i < sizeof shares / sizeof *shares && most < 0; i++) {
        const double at[2] = {middle[0] + shares[i] * along[0], middle[1] + shares[i] * along[1]};
        const double room = hn_label_room(s, placed, at, half);
        if (room > most) {
            most = room;
            memcpy(out, at, sizeof at);
        }
    }
}

/// A dimension line beside its bar [px].
typedef struct dimension {
    double side[2]; ///< unit vector from the bar to the line
    double off;     ///< from the bar to the line
    double line[2][2];
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
    double outer[2] = {-u[1], u[0]}, best = -HUGE_VAL;
    if (outer[0] * (a[0] + b[0] - 2 * middle[0]) + outer[1] * (a[1] + b[1] - 2 * middle[1]) < 0) {
        outer[0] = -outer[0];
        outer[1] = -outer[1];
    }
    dimension out = {.off = 0};
    for (int k = 0; k < 2 * TIERS; k++) {
        const double sign = k % 2 ? -1 : 1, off = 1.1 * s->bar + (1.1 + 1.3 * (k / 2)) * s->font;
        dimension at = {.side = {sign * outer[0], sign * outer[1]}, .off = off};
        for (int i = 0; i < 2; i++) {
            at.line[0][i] = a[i] + off * at.side[i];
            at.line[1][i] = b[i] + off * at.side[i];
        }
        const double text[2] = {(at.line[0][0] + at.line[1][0]) / 2,
                                (at.line[0][1] + at.line[1][1]) / 2};
        const double room = hn_label_room_of_all(s, d, points, placed, text, half);
        const double worth =
            fmin(room, 0.3 * s->font) -
            s->font * (1.5 * share_covered(s, at.line, placed) + 0.3 * (k / 2) + 0.2 * (k % 2));
        if (worth > best) {
            best = worth;
            out = at;
        }
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
    }

    // arrows from the middle to both ends, and the value on them
    const double middle_at[2] = {(a[0] + b[0]) / 2 + off * side[0],
                                 (a[1] + b[1]) / 2 + off * side[1]};
    for (int i = 0; i < 2; i++) {
        hn_canvas_arrow(c, middle_at[0], middle_at[1], at->line[i][0], at->line[i][1],
                        0.6 * s->font, &thin);
    }
    const double half = 0.5 * hn_canvas_text_width(0.85 * s->font, text);
    const double along[2] = {b[0] - a[0], b[1] - a[1]};
    double xy[2];
    place_on_line(s, placed, middle_at, along, half, xy);
    draw_value(c, s, xy[0], xy[1], text);
    hn_label_remember(placed, xy, half);
    hn_label_keep_off_line(placed, at->line);
}

/// The dimension line of two points of the pose, where they are not too near to each other.
static void dimension_between(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                              const hn_snapshot_pose *pose, const int ends[2],
                              hn_label_places *placed) {
    double middle[2], a[2], b[2];
    char text[HN_SI_TEXT];
    const double *p = pose->points + 3 * ends[0], *q = pose->points + 3 * ends[1];
    middle_of(s, d, pose->points, middle);
    hn_sheet_pixel(s, p, a);
    hn_sheet_pixel(s, q, b);
    hn_si_format(hypot(hypot(q[0] - p[0], q[1] - p[1]), q[2] - p[2]), "m", 3, text);
    if (hypot(b[0] - a[0], b[1] - a[1]) >= SHORTEST_DIMENSION * s->font) {
        const double half = 0.5 * hn_canvas_text_width(0.85 * s->font, text);
        const dimension at = lay_dimension(s, d, pose->points, a, b, middle, half, placed);
        draw_dimension(c, s, a, b, &at, text, placed);
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
    for (int i = 0; i < d->n_shapes && n == 2; i++) {
        const hn_shape *bar = &d->shapes[i];
        if (bar->kind == HN_SHAPE_BAR && ((bar->p == ends[0] && bar->q == ends[1]) ||
                                          (bar->p == ends[1] && bar->q == ends[0]))) {
            return false;
        }
    }
    return n == 2;
}

void hn_snapshot_dimensions(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                            const hn_snapshot_pose *pose, hn_label_places *placed) {
    int ends[2];
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *bar = &d->shapes[i];
        if (bar->kind == HN_SHAPE_BAR && !is_repeated(d, i)) {
            dimension_between(c, s, d, pose, (const int[2]){bar->p, bar->q}, placed);
        }
    }
    if (find_ground_link(d, ends)) {
        dimension_between(c, s, d, pose, ends, placed);
    }
}

// ---- the list of what is drawn ----

static void put_point(hn_strbuf *world, hn_strbuf *pixels, const hn_sheet *s, const double *at) {
    double xy[2];
    hn_sheet_pixel(s, at, xy);
    hn_json_array(world);
    for (int i = 0; i < 3; i++) {
        hn_json_number(world, at[i]);
    }
    hn_json_end_array(world);
    hn_json_array(pixels);
    hn_json_number(pixels, round(100 * xy[0]) / 100);
    hn_json_number(pixels, round(100 * xy[1]) / 100);
    hn_json_end_array(pixels);
}

/// The numbers of a shape's points: one, two, or those of a polygon.
static int points_of(const hn_shape *shape, int k) {
    if (shape->kind == HN_SHAPE_POLYGON) {
        return k < shape->n ? shape->p + k : -1;
    }
    const bool two = shape->kind == HN_SHAPE_BAR || shape->kind == HN_SHAPE_SPRING ||
                     shape->kind == HN_SHAPE_DAMPER || shape->kind == HN_SHAPE_SLIDER ||
                     shape->kind == HN_SHAPE_GUIDE;
    return k == 0 ? shape->p : k == 1 && two ? shape->q : -1;
}

static void put_shape(hn_strbuf *b, const hn_sheet *s, const hn_drawing *d, const hn_shape *shape,
                      const double *points, int pose) {
    hn_strbuf world, pixels;
    hn_strbuf_init(&world);
    hn_strbuf_init(&pixels);
    hn_json_array(&world);
    hn_json_array(&pixels);
    for (int k = 0, point; (point = points_of(shape, k)) >= 0; k++) {
        put_point(&world, &pixels, s, points + 3 * point);
    }
    hn_json_end_array(&world);
    hn_json_end_array(&pixels);

    hn_json_object(b);
    hn_json_put_string(b, "kind", hn_shape_kind_name(shape->kind));
    hn_json_put_int(b, "pose", pose);
    if (shape->kind == HN_SHAPE_PIVOT || shape->kind == HN_SHAPE_GROUND) {
        hn_json_put_string(b, "joint", hn_joint_type_name(shape->joint));
    }
    hn_json_key(b, "points");
    hn_json_raw(b, hn_strbuf_text(&world));
    hn_json_key(b, "pixels");
    hn_json_raw(b, hn_strbuf_text(&pixels));
    hn_json_key(b, "labels");
    hn_json_array(b);
    for (int k = 0, point; (point = points_of(shape, k)) >= 0; k++) {
        hn_json_string(b, d->labels[point] ? d->labels[point] : "");
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
    b->failed |= world.failed || pixels.failed;
    hn_strbuf_reset(&world);
    hn_strbuf_reset(&pixels);
}

void hn_snapshot_primitives(hn_strbuf *b, const hn_sheet *s, const hn_drawing *d,
                            const hn_snapshot_pose *poses, int n_poses,
                            const hn_snapshot_opts *opts) {
    hn_json_key(b, "primitives");
    hn_json_array(b);
    for (int i = 0; i < n_poses; i++) {
        for (int k = 0; k < d->n_shapes && hn_pose_is_drawable(d, &poses[i]); k++) {
            put_shape(b, s, d, &d->shapes[k], poses[i].points, i);
        }
    }
    hn_json_end_array(b);

    // lines that were passed, and forces
    hn_json_key(b, "traces");
    hn_json_array(b);
    for (int i = 0; i < n_poses; i++) {
        hn_json_int(b, poses[i].trace ? poses[i].n_trace : 0);
    }
    hn_json_end_array(b);
    hn_json_key(b, "loads");
    hn_json_array(b);
    for (int i = 0; i < opts->n_loads; i++) {
        const hn_snapshot_load *load = &opts->loads[i];
        const double *at =
            load->point < 0 ? load->place : poses[s->selected].points + 3 * load->point;
        hn_json_object(b);
        hn_json_put_numbers(b, "place", at, 3);
        hn_json_put_numbers(b, "force", load->force, 3);
        hn_json_put_string(b, "unit", load->unit);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_put_number(b, "longest_load", hn_snapshot_longest_load(s, opts));
    hn_json_key(b, "angles");
    hn_json_array(b);
    for (int i = 0; i < opts->n_angles; i++) {
        const hn_snapshot_angle *angle = &opts->angles[i];
        hn_json_object(b);
        hn_json_put_string(b, "name", angle->name);
        hn_json_put_number(b, "value", angle->value);
        hn_json_put_numbers(b, "pivot", poses[s->selected].points + 3 * angle->pivot, 3);
        hn_json_put_numbers(b, "end", poses[s->selected].points + 3 * angle->end, 3);
        hn_json_put_numbers(b, "zero", angle->zero, 3);
        hn_json_put_numbers(b, "quarter", angle->quarter, 3);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}
