// SPDX-License-Identifier: GPL-3.0-or-later
// The sheet: what is there, where it goes, and the colours of a pose.
#include "render/snapshot_sheet.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// [px] from this width on inset and legend are beside the drawing
static const double WIDE_ENOUGH = 560;
static const double CLOSED = 1e-12;       // of the view: a smaller tear is not magnified
static const double TEAR_IN_INSET = 0.4;  // the tear's share of the inset
static const double ROOM_AROUND = 0.10;   // of the view, on each side
static const double LOWEST_GLASS = 5;     // [letters] of an inset that gives room to the legend
static const double FLAT = 1e-9;          // [m] a mechanism that is no thicker lies in a plane
static const double EDGE_ON = 0.2;        // a plane that is seen narrower has no symbols
static const double SMALLEST_VIEW = 1e-6; // [m]

// ---- what is there ----

bool hn_pose_is_drawable(const hn_drawing *drawing, const hn_snapshot_pose *pose) {
    if (pose->points == NULL) {
        return false;
    }
    for (int i = 0; i < 3 * drawing->n_points; i++) {
        if (!isfinite(pose->points[i])) {
            return false;
        }
    }
    return true;
}

double hn_tear_gap(const hn_drawing *drawing, const hn_snapshot_pose *pose, int tear) {
    const double *p = pose->points + 3 * drawing->tears[tear][0];
    const double *q = pose->points + 3 * drawing->tears[tear][1];
    return hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

static hn_tear find_widest(const hn_drawing *d, const hn_snapshot_pose *poses, int n_poses) {
    hn_tear widest = {-1, -1, -1};
    for (int i = 0; i < n_poses; i++) {
        const bool counts = !poses[i].faint && hn_pose_is_drawable(d, &poses[i]);
        for (int k = 0; k < d->n_tears && counts; k++) {
            const double gap = hn_tear_gap(d, &poses[i], k);
            if (gap > widest.gap) {
                widest = (hn_tear){i, k, gap};
            }
        }
    }
    return widest;
}

static int find_selected(const hn_drawing *d, const hn_snapshot_pose *poses, int n_poses) {
    int first = -1;
    for (int i = n_poses - 1; i >= 0; i--) {
        if (hn_pose_is_drawable(d, &poses[i])) {
            if (poses[i].selected) {
                return i;
            }
            first = i;
        }
    }
    return first;
}

static void fit_view(const hn_drawing *d, const hn_snapshot_pose *poses, int n_poses,
                     const hn_view *look, double view[4]) {
    double box[4] = {(double)INFINITY, -(double)INFINITY, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < n_poses; i++) {
        for (int k = 0; k < d->n_points && hn_pose_is_drawable(d, &poses[i]); k++) {
            double p[2];
            hn_view_project(look, poses[i].points + 3 * k, p);
            box[0] = fmin(box[0], p[0]);
            box[1] = fmax(box[1], p[0]);
            box[2] = fmin(box[2], p[1]);
            box[3] = fmax(box[3], p[1]);
        }
    }
    memcpy(view, box, sizeof box);
}

// ---- where it goes ----

/// Boxes of drawing, inset and legend. Wide: a column on the right. Narrow: both
/// below it, side by side.
static void place_boxes(hn_sheet *s, int n_poses, int has_inset) {
    const double margin = 1.4 * s->font, header = 4.2 * s->font;
    const double rows = n_poses * 2.7 * s->font;
    if (s->width >= WIDE_ENOUGH) {
        const double column = fmin(340, fmax(190, 0.28 * s->width));
        const double x = s->width - margin - column;
        const double side = has_inset ? fmin(column, 0.5 * (s->height - header - margin)) : 0;
        s->inset = (hn_box){x, header, column, side};
        s->legend = (hn_box){x, header + side + 1.6 * s->font, column, rows};
        s->drawing = (hn_box){margin, header, x - 2 * margin, s->height - header - margin};
    } else {
        const double side = has_inset ? 0.36 * s->width : 0;
        const double below = fmin(fmax(rows, side + margin), 0.45 * s->height);
        s->drawing =
            (hn_box){margin, header, s->width - 2 * margin, s->height - header - below - margin};
        s->inset =
            (hn_box){s->width - margin - side, s->height - below, side, fmin(side, below - margin)};
        s->legend = (hn_box){margin, s->height - below, s->width - 2 * margin - side, below};
    }
}

/// The drawing alone, on the whole sheet.
static void place_alone(hn_sheet *s) {
    const double margin = 0.6 * s->font;
    s->drawing = (hn_box){margin, 0, s->width - 2 * margin, s->height - margin};
}

/// The scale that fits the view, grown by the room around, into the drawing's box above the scale
/// bar.
static void place_view(hn_sheet *s) {
    double *v = s->view;
    const double size = fmax(SMALLEST_VIEW, fmax(v[1] - v[0], v[3] - v[2]));
    const double room = ROOM_AROUND * size;
    const double width = v[1] - v[0] + 2 * room, height = v[3] - v[2] + 2 * room;
    const double box_height = fmax(1, s->drawing.height - 2.4 * s->font);
    s->scale = fmin(s->drawing.width / width, box_height / height);
    s->origin[0] = s->drawing.x + s->drawing.width / 2 - s->scale * (v[0] + v[1]) / 2;
    s->origin[1] = s->drawing.y + box_height / 2 + s->scale * (v[2] + v[3]) / 2;
    s->bar = fmin(20, fmax(5, 0.032 * s->scale * size));
    s->scale_bar = hn_round_125(0.25 * s->drawing.width / s->scale);
}

static void choose_magnification(hn_sheet *s) {
    const double gap = s->widest.gap * s->scale; // [px]
    const double size = fmax(s->view[1] - s->view[0], s->view[3] - s->view[2]);
    s->is_closed = !(s->widest.gap > CLOSED * size);
    s->magnification = s->is_closed || gap >= TEAR_IN_INSET * s->glass
                           ? 1
                           : hn_round_125(TEAR_IN_INSET * s->glass / gap);
}

/// Finds whether the mechanism lies in a plane of constant z that is seen at a slant, neither from
/// the front nor edge on.
static void find_plane(hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; pose && i < d->n_points; i++) {
        low = fmin(low, pose->points[3 * i + 2]);
        high = fmax(high, pose->points[3 * i + 2]);
    }
    for (int k = 0; k < 2; k++) {
        s->plane[k][0] = s->look.right[k];
        s->plane[k][1] = -s->look.up[k];
    }
    const double open = fabs(s->look.toward[2]);
    s->is_slanted = s->in_space && high - low <= FLAT && open > EDGE_ON;
}

hn_status hn_sheet_make(hn_sheet *s, int width, int height, const hn_drawing *d,
                        const hn_snapshot_pose *poses, int n_poses, const hn_snapshot_opts *opts,
                        hn_diag *diag) {
    memset(s, 0, sizeof *s);
    s->width = width;
    s->height = height;
    s->font = fmin(24, fmax(10, 0.0235 * fmin(width, 1.4 * height)));
    s->line = 2 * fmin(1.3, fmax(0.65, s->font / 16));
    s->look = opts->look;
    s->in_space = s->look.toward[2] < 1 - 1e-12;
    s->selected = find_selected(d, poses, n_poses);
    find_plane(s, d, s->selected < 0 ? NULL : &poses[s->selected]);
    if (s->selected < 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "none of the %d poses has finite points to draw", n_poses);
    }
    s->widest = opts->bare ? (hn_tear){-1, -1, -1} : find_widest(d, poses, n_poses);
    if (opts->view[1] > opts->view[0]) {
        memcpy(s->view, opts->view, sizeof s->view);
    } else {
        fit_view(d, poses, n_poses, &s->look, s->view);
    }
    if (opts->bare) {
        place_alone(s);
    } else {
        place_boxes(s, n_poses, s->widest.pose >= 0);
    }
    place_view(s);
    s->glass = fmin(s->inset.width, s->inset.height);
    choose_magnification(s);
    return HN_OK;
}

void hn_sheet_place(const hn_sheet *s, const double plane[2], double out[2]) {
    out[0] = s->origin[0] + s->scale * plane[0];
    out[1] = s->origin[1] - s->scale * plane[1];
}

void hn_sheet_pixel(const hn_sheet *s, const double *world, double out[2]) {
    double plane[2];
    hn_view_project(&s->look, world, plane);
    hn_sheet_place(s, plane, out);
}

double hn_sheet_mechanism(const hn_sheet *s) {
    return s->scale * fmax(s->view[1] - s->view[0], s->view[3] - s->view[2]);
}

void hn_sheet_length(const hn_sheet *s, double metres, int digits, char out[HN_SI_TEXT]) {
    if (s->unit == HN_UNIT_ANY || !(metres > 0)) {
        hn_si_format(metres, "m", digits, out);
        return;
    }
    const double value = hn_round_digits(metres * (s->unit == HN_UNIT_MM ? 1000 : 1), digits);
    const int whole = (int)floor(log10(value)) + 1; // digits before the point, below 1: zeros after
    const int decimals = whole < digits ? digits - whole : 0;
    snprintf(out, HN_SI_TEXT, "%.*f %s", decimals, value, s->unit == HN_UNIT_MM ? "mm" : "m");
}

void hn_sheet_make_room(hn_sheet *s, double wanted) {
    const double there = s->height - s->legend.y;
    if (s->width >= WIDE_ENOUGH && s->inset.height > 0 && there < wanted) {
        const double lowest = (2 * HN_INSET_STRIP + LOWEST_GLASS) * s->font;
        const double less = fmin(wanted - there, fmax(0, s->inset.height - lowest));
        s->inset.height -= less;
        s->legend.y -= less;
        s->glass = fmin(s->glass, s->inset.height - 2 * HN_INSET_STRIP * s->font);
        choose_magnification(s);
    }
}

// ---- colours ----

hn_stroke hn_slot_stroke(hn_theme theme, int slot, double width) {
    const hn_look *look = hn_look_get(slot);
    return (hn_stroke){.paint = {look->colour[theme], 1},
                       .width = width,
                       .n_dash = look->n_dash,
                       .dash = look->dash};
}

hn_stroke hn_trace_stroke(hn_theme theme, int slot, double width, int k) {
    static const double dashes[][4] = {{0}, {7, 4}, {2, 4}, {9, 3, 2, 3}};
    static const int lengths[] = {0, 2, 2, 4};
    hn_stroke thin = hn_slot_stroke(theme, slot, 0.6 * width);
    const int row = k % (int)(sizeof lengths / sizeof *lengths);
    thin.dash = dashes[row];
    thin.n_dash = lengths[row];
    return thin;
}

uint32_t hn_tint(hn_theme theme, uint32_t colour, double share) {
    const uint32_t paper = hn_surface_get(theme)->paper;
    uint32_t mixed = 0;
    for (int shift = 16; shift >= 0; shift -= 8) {
        const double from = paper >> shift & 0xff, to = colour >> shift & 0xff;
        mixed |= (uint32_t)lround(from + share * (to - from)) << shift;
    }
    return mixed;
}
