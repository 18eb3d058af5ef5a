// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_marks.h"

#include "render/snapshot_labels.h"

#include <math.h>

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
