// SPDX-License-Identifier: GPL-3.0-or-later
// The picture from its parts: the words around the drawing, the order of painting, and the
// description.
#include "render/snapshot.h"

#include "base/units.h"
#include "render/snapshot_angles.h"
#include "render/snapshot_labels.h"
#include "render/snapshot_legend.h"
#include "render/snapshot_lengths.h"
#include "render/snapshot_marks.h"
#include "render/snapshot_shapes.h"
#include "render/snapshot_sheet.h"
#include "render/snapshot_tear.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SMALL_LEGEND = 0.85; // letters of a legend beside the whole inset
enum { TEXT = 256 };

hn_snapshot_opts hn_snapshot_opts_default(void) {
    return (hn_snapshot_opts){.time = (double)NAN, .look = hn_view_front(), .labels = 1};
}

// ---- words ----

static void draw_header(hn_canvas *c, const hn_sheet *s, const hn_snapshot_opts *opts) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const double left = s->drawing.x, right = s->width - left;
    double time_width = 0;
    if (isfinite(opts->time)) {
        char text[TEXT];
        snprintf(text, sizeof text, "%st = %.3f s", opts->stopped ? "stopped at " : "", opts->time);
        hn_canvas_text(c, right, 2.2 * s->font, 1.1 * s->font, HN_ALIGN_RIGHT,
                       hn_paint_solid(surface->ink), text);
        time_width = hn_canvas_text_width(1.1 * s->font, text) + s->font;
    }
    if (opts->title != NULL && !opts->continued) {
        hn_legend_text(c, left, 2.2 * s->font, 1.3 * s->font, right - left - time_width,
                       surface->ink, opts->title);
    }
    if (opts->caption != NULL && !opts->continued) {
        hn_legend_text(c, left, 3.7 * s->font, 0.9 * s->font, right - left, surface->muted,
                       opts->caption);
    }
}

static void draw_scale_bar(hn_canvas *c, const hn_sheet *s) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const double x = s->drawing.x, y = s->drawing.y + s->drawing.height - 0.5 * s->font,
                 tick = 0.35 * s->font;
    const double length = s->scale * s->scale_bar;
    const double xy[] = {x, y - tick, x, y, x + length, y, x + length, y - tick};
    const hn_stroke stroke = hn_stroke_solid(surface->muted, 1.5);
    hn_canvas_line(c, xy, 4, &stroke);
    char text[HN_SI_TEXT];
    hn_sheet_length(s, s->scale_bar, 1, text);
    hn_canvas_text(c, x + length / 2, y - 0.5 * s->font, 0.9 * s->font, HN_ALIGN_CENTRE,
                   hn_paint_solid(surface->muted), text);
}

/// Draws the world axes at the lower right, in views other than the front.
static void draw_triad(hn_canvas *c, const hn_sheet *s) {
    static const char *const names[3] = {"x", "y", "z"};
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    if (!s->in_space) {
        return;
    }
    const double length = 2.2 * s->font, x = s->drawing.x + s->drawing.width - 1.6 * length,
                 y = s->drawing.y + s->drawing.height - 1.1 * length;
    const hn_stroke stroke = hn_stroke_solid(surface->muted, 0.7 * s->line);
    for (int i = 0; i < 3; i++) {
        const double dx = length * s->look.right[i], dy = -length * s->look.up[i];
        if (hypot(dx, dy) < 0.15 * length) {
            continue; // seen end on
        }
        hn_canvas_arrow(c, x, y, x + dx, y + dy, 0.45 * s->font, &stroke);
        hn_canvas_text(c, x + 1.3 * dx, y + 1.3 * dy + 0.3 * s->font, 0.85 * s->font,
                       HN_ALIGN_CENTRE, hn_paint_solid(surface->muted), names[i]);
    }
}

// ---- the two doors ----

static void draw_poses(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, int n_poses, const hn_snapshot_opts *opts) {
    // the reference beneath all, then the ghosts, the selected one on top
    for (int pass = 0; pass < 3; pass++) {
        for (int i = 0; i < n_poses; i++) {
            const int wanted = i == s->selected ? 2 : poses[i].slot == HN_LOOK_REFERENCE ? 0 : 1;
            if (wanted == pass && hn_pose_is_drawable(d, &poses[i])) {
                hn_snapshot_pose_draw(c, s, d, &poses[i], i == s->selected, opts->n_traces);
            }
        }
    }
}

/// Paints the sheet from the ground up: what lies on top comes last. The texts of the drawing are
/// in `placed` afterwards.
static void paint(hn_canvas *c, hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                  int n_poses, const hn_snapshot_opts *opts, hn_label_places *placed) {
    const hn_snapshot_pose *selected = &poses[s->selected];
    hn_snapshot_choose_unit(s, d, selected, opts);
    hn_snapshot_ground(c, s, d, selected);
    draw_poses(c, s, d, poses, n_poses, opts);
    hn_snapshot_markers(c, s, d, poses, n_poses);

    // texts, each off the earlier ones
    hn_snapshot_hatching(s, d, selected, placed);
    hn_label_keep_off_corners(s, placed);
    hn_label_keep_off_loads(s, selected, opts, placed);
    if (opts->dimensions) {
        hn_snapshot_lengths(c, s, d, selected, placed);
    }
    hn_snapshot_angles(c, s, d, selected, opts, placed);
    hn_snapshot_loads(c, s, d, selected, opts, placed);
    if (opts->labels) {
        hn_snapshot_names(c, s, d, poses, opts, placed);
    }
    hn_snapshot_times(c, s, d, poses, n_poses, placed);

    // beside the drawing
    if (!opts->bare) {
        hn_sheet_make_room(s, SMALL_LEGEND * hn_legend_height(s, d, poses, n_poses, opts, placed));
    }
    hn_snapshot_tears(c, s, d, poses, n_poses);
    draw_scale_bar(c, s);
    draw_triad(c, s);
    if (!opts->bare) {
        draw_header(c, s, opts);
        hn_snapshot_legend(c, s, d, poses, n_poses, opts, placed);
    }
}

/// Makes the sheet and paints it.
static hn_status draw_sheet(hn_canvas *c, const hn_drawing *drawing, const hn_snapshot_pose *poses,
                            int n_poses, const hn_snapshot_opts *opts, hn_sheet *sheet,
                            hn_label_places *placed, hn_diag *diag) {
    HN_TRY(hn_sheet_make(sheet, hn_canvas_width(c), hn_canvas_height(c), drawing, poses, n_poses,
                         opts, diag));

    // scratch for the order of painting
    const size_t n = (size_t)drawing->n_shapes * HN_SHAPE_ORDERS + 1;
    sheet->shapes = malloc(n * sizeof *sheet->shapes);
    sheet->depth = malloc(n * sizeof *sheet->depth);
    hn_status status = HN_OK;
    if (sheet->shapes && sheet->depth) {
        paint(c, sheet, drawing, poses, n_poses, opts, placed);
    } else {
        status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    free(sheet->shapes);
    free(sheet->depth);
    return status;
}

hn_status hn_snapshot_draw(hn_canvas *c, const hn_drawing *drawing, const hn_snapshot_pose *poses,
                           int n_poses, const hn_snapshot_opts *opts, hn_diag *diag) {
    HN_ASSERT(c != NULL && drawing != NULL && (poses != NULL || n_poses == 0) && opts != NULL);
    hn_sheet sheet;
    hn_label_places placed = {0};
    return draw_sheet(c, drawing, poses, n_poses, opts, &sheet, &placed, diag);
}

hn_status hn_snapshot_find_place(hn_snapshot_place *out, int width, int height,
                                 const hn_drawing *drawing, const hn_snapshot_pose *poses,
                                 int n_poses, const hn_snapshot_opts *opts, hn_diag *diag) {
    hn_sheet sheet;
    HN_TRY(hn_sheet_make(&sheet, width, height, drawing, poses, n_poses, opts, diag));
    *out = (hn_snapshot_place){sheet.scale, sheet.origin[0], sheet.origin[1],
                               hn_sheet_mechanism(&sheet)};
    return HN_OK;
}

static void describe_poses(hn_strbuf *b, const hn_sheet *s, const hn_drawing *d,
                           const hn_snapshot_pose *poses, int n_poses) {
    hn_json_key(b, "poses");
    hn_json_array(b);
    for (int i = 0; i < n_poses; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", poses[i].name);
        hn_json_put_int(b, "slot", poses[i].slot);
        hn_json_put_bool(b, "drawn", hn_pose_is_drawable(d, &poses[i]));
        hn_json_put_bool(b, "selected", i == s->selected);
        hn_json_put_bool(b, "faint", poses[i].faint);
        hn_json_put_string(b, "note", poses[i].note);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void describe_tears(hn_strbuf *b, const hn_drawing *d, const hn_snapshot_pose *poses,
                           int n_poses) {
    hn_json_key(b, "tears");
    hn_json_array(b);
    for (int i = 0; i < n_poses; i++) {
        for (int k = 0; k < d->n_tears && hn_pose_is_drawable(d, &poses[i]); k++) {
            hn_json_object(b);
            hn_json_put_string(b, "name", d->tear_names[k]);
            hn_json_put_int(b, "pose", i);
            hn_json_put_number(b, "gap", hn_tear_gap(d, &poses[i], k));
            hn_json_end_object(b);
        }
    }
    hn_json_end_array(b);
}

static void describe_inset(hn_strbuf *b, const hn_sheet *s, const hn_drawing *d) {
    hn_json_key(b, "inset");
    if (s->widest.pose < 0) {
        hn_json_null(b);
        return;
    }
    hn_json_object(b);
    hn_json_put_string(b, "tear", d->tear_names[s->widest.index]);
    hn_json_put_int(b, "pose", s->widest.pose);
    hn_json_put_number(b, "gap", s->widest.gap);
    hn_json_put_number(b, "magnification", s->magnification);
    hn_json_end_object(b);
}

hn_status hn_snapshot_describe(hn_strbuf *b, int width, int height, const hn_drawing *drawing,
                               const hn_snapshot_pose *poses, int n_poses,
                               const hn_snapshot_opts *opts, hn_diag *diag) {
    HN_ASSERT(b != NULL && drawing != NULL && (poses != NULL || n_poses == 0) && opts != NULL);
    // a scratch canvas: places of texts are found while they are drawn
    hn_sheet sheet;
    hn_label_places placed = {0};
    hn_canvas *c = NULL;
    HN_TRY(hn_canvas_create(width, height, HN_THEME_LIGHT, &c, diag));
    const hn_status status = draw_sheet(c, drawing, poses, n_poses, opts, &sheet, &placed, diag);
    hn_canvas_free(c);
    if (status != HN_OK) {
        return status;
    }
    hn_json_object(b);
    hn_json_put_numbers(b, "view", sheet.view, 4);
    hn_json_put_numbers(b, "toward_viewer", sheet.look.toward, 3);
    hn_json_put_number(b, "metres_per_pixel", 1 / sheet.scale);
    describe_poses(b, &sheet, drawing, poses, n_poses);
    describe_tears(b, drawing, poses, n_poses);
    describe_inset(b, &sheet, drawing);
    hn_json_put_number(b, "scale_bar", sheet.scale_bar);
    hn_json_put_number(b, "time", opts->time);
    hn_json_put_bool(b, "stopped", opts->stopped);
    hn_json_put_number(b, "mechanism_pixels", hn_sheet_mechanism(&sheet));
    hn_snapshot_primitives(b, &sheet, drawing, poses, n_poses, opts);
    hn_label_places_json(b, &sheet, &placed);
    hn_legend_json(b, &sheet, poses, n_poses, opts, &placed);
    hn_json_end_object(b);
    return HN_OK;
}
