// SPDX-License-Identifier: GPL-3.0-or-later
// The picture from its parts: the words around the drawing, the order of painting, and the
// description.
#include "render/snapshot.h"

#include "base/units.h"
#include "render/snapshot_angles.h"
#include "render/snapshot_labels.h"
#include "render/snapshot_marks.h"
#include "render/snapshot_shapes.h"
#include "render/snapshot_sheet.h"
#include "render/snapshot_tear.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LEGEND_TEXT = 4.3;   // from the left of a legend's row to its words [letters]
static const double NOTE_SIZE = 0.85;    // of the letters of a name
static const double SMALLEST_LETTER = 2; // [px]
static const double NOTE_PITCH = 1.25;   // from line to line of a note [its letters]
enum { TEXT = 256, NOTE_LINES = 4 };

hn_snapshot_opts hn_snapshot_opts_default(void) {
    return (hn_snapshot_opts){.time = (double)NAN, .look = hn_view_front(), .labels = 1};
}

// ---- words ----

/// The text, cut to the width with an ellipsis where it is longer.
static void put_text(hn_canvas *c, double x, double y, double size, double width, uint32_t colour,
                     const char *text) {
    char cut[TEXT];
    snprintf(cut, sizeof cut, "%s", text);
    size_t n = strlen(cut);
    while (n > 0 && hn_canvas_text_width(size, cut) > width) {
        do {
            n--;
        } while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80);
        snprintf(cut + n, sizeof cut - n, "\xe2\x80\xa6");
    }
    hn_canvas_text(c, x, y, size, HN_ALIGN_LEFT, hn_paint_solid(colour), cut);
}

static void draw_header(hn_canvas *c, const hn_sheet *s, const hn_snapshot_opts *opts) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const double left = s->drawing.x, right = s->width - left;
    double time_width = 0;
    if (isfinite(opts->time)) {
        char text[TEXT];
        snprintf(text, sizeof text, "t = %.3f s", opts->time);
        hn_canvas_text(c, right, 2.2 * s->font, 1.1 * s->font, HN_ALIGN_RIGHT,
                       hn_paint_solid(surface->ink), text);
        time_width = hn_canvas_text_width(1.1 * s->font, text) + s->font;
    }
    if (opts->title != NULL) {
        put_text(c, left, 2.2 * s->font, 1.3 * s->font, right - left - time_width, surface->ink,
                 opts->title);
    }
    if (opts->caption != NULL) {
        put_text(c, left, 3.7 * s->font, 0.9 * s->font, right - left, surface->muted,
                 opts->caption);
    }
}

/// The bytes of the text that a line of this width takes, up to a space where there is one.
static size_t fit_line(double size, double width, const char *text) {
    char line[TEXT];
    size_t taken = 0;
    for (size_t n = 0; text[n] && n + 1 < sizeof line;) {
        n += 1 + strcspn(text + n + 1, " ");
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        if (taken > 0 && hn_canvas_text_width(size, line) > width) {
            break;
        }
        taken = n;
    }
    return taken;
}

/// In lines of that width, the last of NOTE_LINES cut with an ellipsis. Returns how many there are;
/// c = NULL: counts only.
static int put_note(hn_canvas *c, double x, double y, double size, double width, uint32_t colour,
                    const char *text) {
    int lines = 0;
    while (*text && lines < NOTE_LINES) {
        const int last = lines == NOTE_LINES - 1;
        const size_t n = last ? strlen(text) : fit_line(size, width, text);
        char line[TEXT];
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        if (c) {
            put_text(c, x, y + NOTE_PITCH * size * lines, size, width, colour, line);
        }
        lines++;
        text += n;
        text += strspn(text, " ");
    }
    return lines;
}

static const char *note_of(const hn_drawing *d, const hn_snapshot_pose *pose) {
    return pose->note != NULL ? pose->note : hn_pose_is_drawable(d, pose) ? "" : "no pose to draw";
}

/// The room right of the sample of its line, for a size of letters.
static double legend_room(const hn_sheet *s, double font) {
    return s->legend.width - LEGEND_TEXT * font;
}

/// Returns how far the next row is below this one: a name and a note of a line or more.
static double legend_pitch(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                           double font) {
    const double size = NOTE_SIZE * font;
    const int lines = put_note(NULL, 0, 0, size, legend_room(s, font), 0, note_of(d, pose));
    return 2.7 * font + NOTE_PITCH * size * (lines > 1 ? lines - 1 : 0);
}

static double legend_height(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                            int n_poses, double font) {
    double height = 0.4 * font;
    for (int i = 0; i < n_poses; i++) {
        height += poses[i].faint ? 0 : legend_pitch(s, d, &poses[i], font);
    }
    return height;
}

static void draw_legend_row(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                            const hn_snapshot_pose *pose, bool selected, double y, double font) {
    const hn_theme theme = hn_canvas_theme(c);
    const hn_surface *surface = hn_surface_get(theme);
    const double sample = 3.6 * font, x = s->legend.x, text = x + LEGEND_TEXT * font;
    const double room = legend_room(s, font), middle = y - 0.32 * font;
    hn_stroke stroke = hn_slot_stroke(theme, pose->slot, s->line);
    stroke.n_dash = selected ? 0 : stroke.n_dash; // as in the drawing
    hn_canvas_segment(c, x, middle, x + sample, middle, &stroke);
    hn_canvas_disc(c, x + sample / 2, middle, 0.55 * font, hn_paint_solid(surface->paper));
    hn_canvas_marker(c, hn_look_get(pose->slot)->marker, x + sample / 2, middle, 0.75 * font,
                     stroke.paint);
    put_text(c, text, y, font, room, surface->ink, pose->name != NULL ? pose->name : "");
    put_note(c, text, y + 1.15 * font, NOTE_SIZE * font, room, surface->muted, note_of(d, pose));
}

static void draw_legend(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *poses, int n_poses) {
    double font = s->font, y = s->legend.y;
    // smaller until they fit; narrower letters also need fewer lines
    while (font > SMALLEST_LETTER && legend_height(s, d, poses, n_poses, font) > s->height - y) {
        font *= 0.96;
    }
    for (int i = 0; i < n_poses; i++) {
        if (!poses[i].faint) {
            draw_legend_row(c, s, d, &poses[i], i == s->selected, y + font, font);
            y += legend_pitch(s, d, &poses[i], font);
        }
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
    hn_si_format(s->scale_bar, "m", 1, text);
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
                       const hn_snapshot_pose *poses, int n_poses) {
    // the reference beneath all, then the ghosts, the selected one on top
    for (int pass = 0; pass < 3; pass++) {
        for (int i = 0; i < n_poses; i++) {
            const int wanted = i == s->selected ? 2 : poses[i].slot == HN_LOOK_REFERENCE ? 0 : 1;
            if (wanted == pass && hn_pose_is_drawable(d, &poses[i])) {
                hn_snapshot_pose_draw(c, s, d, &poses[i], i == s->selected);
            }
        }
    }
}

hn_status hn_snapshot_draw(hn_canvas *c, const hn_drawing *drawing, const hn_snapshot_pose *poses,
                           int n_poses, const hn_snapshot_opts *opts, hn_diag *diag) {
    HN_ASSERT(c != NULL && drawing != NULL && (poses != NULL || n_poses == 0) && opts != NULL);
    hn_sheet sheet;
    HN_TRY(hn_sheet_make(&sheet, hn_canvas_width(c), hn_canvas_height(c), drawing, poses, n_poses,
                         opts, diag));

    // scratch for the order of painting
    const hn_snapshot_pose *selected = &poses[sheet.selected];
    const size_t n_shapes = (size_t)drawing->n_shapes + 1;
    sheet.shapes = malloc(n_shapes * sizeof *sheet.shapes);
    sheet.depth = malloc(n_shapes * sizeof *sheet.depth);
    if (!sheet.shapes || !sheet.depth) {
        free(sheet.shapes);
        free(sheet.depth);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // from the ground up: what lies on top comes last
    hn_label_places placed = {0};
    hn_snapshot_ground(c, &sheet, drawing, selected);
    draw_poses(c, &sheet, drawing, poses, n_poses);
    hn_snapshot_markers(c, &sheet, drawing, poses, n_poses);
    hn_label_keep_off_loads(&sheet, selected, opts, &placed);
    if (opts->dimensions) {
        hn_snapshot_dimensions(c, &sheet, drawing, selected, &placed);
    }
    hn_snapshot_angles(c, &sheet, drawing, selected, opts, &placed);
    hn_snapshot_labels(c, &sheet, drawing, selected, opts, &placed);
    hn_snapshot_tears(c, &sheet, drawing, poses, n_poses);
    draw_scale_bar(c, &sheet);
    draw_triad(c, &sheet);
    if (!opts->bare) {
        draw_header(c, &sheet, opts);
        draw_legend(c, &sheet, drawing, poses, n_poses);
    }
    free(sheet.shapes);
    free(sheet.depth);
    return HN_OK;
}

hn_status hn_snapshot_find_place(hn_snapshot_place *out, int width, int height,
                                 const hn_drawing *drawing, const hn_snapshot_pose *poses,
                                 int n_poses, const hn_snapshot_opts *opts, hn_diag *diag) {
    hn_sheet sheet;
    HN_TRY(hn_sheet_make(&sheet, width, height, drawing, poses, n_poses, opts, diag));
    *out = (hn_snapshot_place){sheet.scale, sheet.origin[0], sheet.origin[1]};
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
    hn_sheet sheet;
    const hn_status status =
        hn_sheet_make(&sheet, width, height, drawing, poses, n_poses, opts, diag);
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
    hn_snapshot_primitives(b, &sheet, drawing, poses, n_poses, opts);
    hn_json_end_object(b);
    return HN_OK;
}
