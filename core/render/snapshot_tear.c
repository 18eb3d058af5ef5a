// SPDX-License-Identifier: GPL-3.0-or-later
// Tears at cut joints: red in place where they are wide enough to be seen, and the widest one
// magnified.
#include "render/snapshot_tear.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SEEN_IN_PLACE = 1.5; // [px]
enum { TEXT = 192 };

static void draw_in_place(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                          const hn_snapshot_pose *pose) {
    const hn_stroke red = hn_stroke_solid(hn_surface_get(hn_canvas_theme(c))->tear, 1.25 * s->line);
    for (int k = 0; k < d->n_tears; k++) {
        double p[2], q[2];
        hn_sheet_pixel(s, pose->points + 3 * d->tears[k][0], p);
        hn_sheet_pixel(s, pose->points + 3 * d->tears[k][1], q);
        if (hypot(p[0] - q[0], p[1] - q[1]) > SEEN_IN_PLACE) {
            hn_canvas_segment(c, p[0], p[1], q[0], q[1], &red);
        }
    }
}

// ---- the inset ----

/// The inset: a magnifying glass over the middle between the half-joints.
typedef struct glass {
    hn_canvas *c;
    const hn_drawing *d;
    const hn_snapshot_pose *pose;
    hn_view look;
    double centre[2]; ///< of the inset [px]
    double middle[2]; ///< along right and up [m]
    double scale;     ///< [px/m]
    double side;      ///< [px]
    double line;      ///< [px]
} glass;

static void through(const glass *g, int point, double out[2]) {
    double w[2];
    hn_view_project(&g->look, g->pose->points + 3 * point, w);
    out[0] = g->centre[0] + g->scale * (w[0] - g->middle[0]);
    out[1] = g->centre[1] - g->scale * (w[1] - g->middle[1]);
}

/// The ends of the bars that meet at `point`: at a width that suits the inset, not magnified, out
/// to the border.
static void draw_bar_ends(const glass *g, int point) {
    const hn_theme theme = hn_canvas_theme(g->c);
    hn_stroke outline = hn_slot_stroke(theme, g->pose->slot, g->line);
    outline.n_dash = 0;
    outline.closed = 1;

    // bars that end at the point
    for (int i = 0; i < g->d->n_shapes; i++) {
        const hn_shape *shape = &g->d->shapes[i];
        if (shape->kind != HN_SHAPE_BAR || (shape->p != point && shape->q != point)) {
            continue;
        }

        // from the point on, far beyond the border of the inset
        double a[2], b[2], xy[2 * HN_CAPSULE_POINTS];
        through(g, point, a);
        through(g, shape->p == point ? shape->q : shape->p, b);
        const double length = hypot(b[0] - a[0], b[1] - a[1]), far = 3 * g->side;
        if (!(length > 0)) {
            continue;
        }
        const double x = a[0] + far * (b[0] - a[0]) / length,
                     y = a[1] + far * (b[1] - a[1]) / length;
        const int n = hn_canvas_capsule(a[0], a[1], x, y, 0.2 * g->side, xy);
        hn_canvas_polygon(g->c, xy, n, (hn_paint){hn_tint(theme, outline.paint.rgb, 0.3), 0.75});
        hn_canvas_line(g->c, xy, n, &outline);
    }
}

/// One half is the eye, the other the pin that should sit in it.
static void draw_half_joints(const glass *g, const int tear[2]) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(g->c));
    double eye[2], pin[2];
    through(g, tear[0], eye);
    through(g, tear[1], pin);
    const hn_stroke ring = hn_stroke_solid(surface->ink, 2),
                    red = hn_stroke_solid(surface->tear, 3);
    const double r = 0.055 * g->side;
    hn_canvas_disc(g->c, eye[0], eye[1], r, hn_paint_solid(surface->paper));
    hn_canvas_ring(g->c, eye[0], eye[1], r, &ring);
    hn_canvas_disc(g->c, pin[0], pin[1], 0.6 * r, hn_paint_solid(surface->ink));
    hn_canvas_segment(g->c, eye[0], eye[1], pin[0], pin[1], &red);
}

/// "×200" or, raised, "×5·10^8", with its end at x.
static void draw_magnification(hn_canvas *c, const hn_sheet *s, double x, double y, double size) {
    const hn_paint ink = hn_paint_solid(hn_surface_get(hn_canvas_theme(c))->ink);
    const double power = floor(log10(s->magnification) + 1e-9);
    char text[TEXT];
    if (power < 5) {
        snprintf(text, sizeof text, "\xc3\x97%.0f", s->magnification);
    } else {
        const double first = round(s->magnification / pow(10, power));
        char factor[16] = "";
        snprintf(text, sizeof text, "%.0f", power);
        hn_canvas_text(c, x, y - 0.4 * size, 0.7 * size, HN_ALIGN_RIGHT, ink, text);
        x -= hn_canvas_text_width(0.7 * size, text) + 0.12 * size;
        if (first > 1) {
            snprintf(factor, sizeof factor, "%.0f\xc2\xb7", first);
        }
        snprintf(text, sizeof text, "\xc3\x97%s10", factor);
    }
    hn_canvas_text(c, x, y, size, HN_ALIGN_RIGHT, ink, text);
}

static void draw_words(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *pose) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const hn_box *box = &s->inset;
    const double size = 0.9 * s->font, x = box->x + 0.6 * s->font;
    char gap[HN_SI_TEXT], text[TEXT];
    snprintf(text, sizeof text, "%s, %s", d->tear_names[s->widest.index],
             pose->name != NULL ? pose->name : "");
    hn_canvas_text(c, x, box->y + 1.3 * s->font, size, HN_ALIGN_LEFT, hn_paint_solid(surface->ink),
                   text);

    // of a closed joint the legend gives the number; that of the drawn points is another rounding
    hn_si_format(s->widest.gap, "m", 2, gap);
    snprintf(text, sizeof text, "%s%s", s->is_closed ? "closed to rounding" : "gap ",
             s->is_closed ? "" : gap);
    const double bottom = box->y + box->height - 0.7 * s->font;
    hn_canvas_text(c, x, bottom, size, HN_ALIGN_LEFT, hn_paint_solid(surface->ink), text);
    if (!s->is_closed) {
        draw_magnification(c, s, box->x + box->width - 0.6 * s->font, bottom, size);
    }
}

static void draw_inset(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const hn_box *box = &s->inset;
    const int *tear = d->tears[s->widest.index];
    const hn_snapshot_pose *pose = &poses[s->widest.pose];
    const double frame[] = {box->x,
                            box->y,
                            box->x + box->width,
                            box->y,
                            box->x + box->width,
                            box->y + box->height,
                            box->x,
                            box->y + box->height};
    const hn_stroke hairline = {.paint = {surface->hairline, 1}, .width = 1, .closed = 1};
    glass g = {.c = c,
               .d = d,
               .pose = pose,
               .look = s->look,
               .scale = s->scale * s->magnification,
               .side = s->glass,
               .line = s->line};
    g.centre[0] = box->x + box->width / 2;
    g.centre[1] = box->y + box->height / 2;
    double half[2][2];
    for (int k = 0; k < 2; k++) {
        hn_view_project(&s->look, pose->points + 3 * tear[k], half[k]);
    }
    for (int k = 0; k < 2; k++) {
        g.middle[k] = (half[0][k] + half[1][k]) / 2;
    }

    hn_canvas_polygon(c, frame, 4, hn_paint_solid(surface->raised));
    // words have strips of their own above and below the glass
    const int strip = (int)(HN_INSET_STRIP * s->font);
    hn_canvas_clip(c, (int)box->x, (int)box->y + strip, (int)box->width,
                   (int)fmax(1, box->height - 2 * strip));
    draw_bar_ends(&g, tear[0]);
    draw_bar_ends(&g, tear[1]);
    draw_half_joints(&g, tear);
    hn_canvas_unclip(c);
    draw_words(c, s, d, pose);
    hn_canvas_line(c, frame, 4, &hairline);
}

void hn_snapshot_tears(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, int n_poses) {
    for (int i = 0; i < n_poses; i++) {
        if (hn_pose_is_drawable(d, &poses[i])) {
            draw_in_place(c, s, d, &poses[i]);
        }
    }
    if (s->widest.pose >= 0) {
        draw_inset(c, s, d, poses);
    }
}
