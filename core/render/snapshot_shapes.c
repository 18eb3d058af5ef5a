// SPDX-License-Identifier: GPL-3.0-or-later
// The mechanism itself: one function per kind of shape, found through one table.
#include "render/snapshot_shapes.h"

#include "base/units.h"
#include "render/snapshot_joints.h"
#include "render/snapshot_pen.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const double GHOST_OPACITY = 0.6;
static const double FAINT_OPACITY = 0.3;
static const double SELECTED_TINT = 0.30;
static const double PIN_NEARER = 1e-3;  // [scale bars] than the nearest of its bars
static const double FARTHEST = 0.45;    // of its colour that the farthest shape in space keeps
enum { COILS = 7, MAX_POLYGON = 1000 }; // the scene format allows no larger one
enum { TRACE_PIECE = 256 };
enum { ROUND = 12, ARC_STEPS = 8 };    // corners of a circle at least; pieces of each side
static const double GROUND_LINE = 0.8; // lines of supports, of other outlines
static const double RAIL = 0.7;        // lines of guides, of those

// ---- kinds ----

static void draw_bar(const hn_pen *p, const hn_shape *shape) {
    double a[2], b[2], xy[2 * HN_CAPSULE_POINTS];
    hn_pen_at(p, shape->p, a);
    hn_pen_at(p, shape->q, b);
    if (p->is_reference) {
        hn_canvas_segment(p->c, a[0], a[1], b[0], b[1], &p->outline);
        return;
    }
    hn_pen_outlined(p, xy,
                    hn_canvas_capsule(a[0], a[1], b[0], b[1], hn_pen_bar_width(p, shape), xy));
}

/// The direction across a line from a to b [m, world], to its right, as it is seen: level with the
/// picture, or in the plane of a mechanism that is seen at a slant.
static void find_across(const hn_sheet *s, const double *a, const double *b, double out[2]) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
    double from[2], to[2], u[2];
    hn_sheet_pixel(s, a, from);
    hn_sheet_pixel(s, b, to);
    hn_pen_direction(from, to, u);
    out[0] = -u[1];
    out[1] = u[0];
    if (s->is_slanted && length > 0) {
        for (int k = 0; k < 2; k++) {
            out[k] = (dy * s->plane[0][k] - dx * s->plane[1][k]) / length;
        }
    }
}

static void draw_slider(const hn_pen *p, const hn_shape *shape) {
    double a[2], b[2], u[2], v[2], xy[8];
    hn_pen_at(p, shape->p, a);
    hn_pen_at(p, shape->q, b);
    hn_pen_direction(a, b, u);
    find_across(p->s, p->points + 3 * shape->p, p->points + 3 * shape->q, v);
    const double w = hn_pen_bar_width(p, shape), along = 1.3 * w, across = 0.85 * w;
    for (int i = 0; i < 4; i++) {
        const double i_along = (i == 0 || i == 3 ? -1 : 1) * along,
                     i_across = (i < 2 ? -1 : 1) * across;
        xy[2 * i] = a[0] + i_along * u[0] + i_across * v[0];
        xy[2 * i + 1] = a[1] + i_along * u[1] + i_across * v[1];
    }
    hn_pen_outlined(p, xy, 4);
}

static void draw_spring(const hn_pen *p, const hn_shape *shape) {
    double a[2], b[2], u[2], xy[2 * (2 * COILS + 4)];
    hn_pen_at(p, shape->p, a);
    hn_pen_at(p, shape->q, b);
    const double length = hn_pen_direction(a, b, u), lead = 0.15 * length, swing = 0.6 * p->s->bar;
    int n = 0;

    // a straight lead, the coils to either side, a straight lead
    for (int i = -2; i <= 2 * COILS + 1; i++) {
        const bool is_end = i <= -1 || i >= 2 * COILS;
        const double share = (i + 0.5) / (2 * COILS);
        const double s = i == -2              ? 0
                         : i == -1            ? lead
                         : i == 2 * COILS     ? length - lead
                         : i == 2 * COILS + 1 ? length
                                              : lead + share * (length - 2 * lead);
        const double side = is_end ? 0 : i % 2 == 0 ? swing : -swing;
        xy[2 * n] = a[0] + s * u[0] - side * u[1];
        xy[2 * n + 1] = a[1] + s * u[1] + side * u[0];
        n++;
    }
    const hn_stroke wire = {.paint = p->outline.paint, .width = p->outline.width};
    hn_canvas_line(p->c, xy, n, &wire);
}

/// A piston in an open pot: `local` gives points along and across the line as shares of its length
/// and of the bar.
static void draw_local(const hn_pen *p, const double a[2], const double u[2], double length,
                       const double *local, int n) {
    double xy[8];
    for (int i = 0; i < n; i++) {
        const double s = local[2 * i] * length, side = local[2 * i + 1] * p->s->bar;
        xy[2 * i] = a[0] + s * u[0] - side * u[1];
        xy[2 * i + 1] = a[1] + s * u[1] + side * u[0];
    }
    const hn_stroke solid = {.paint = p->outline.paint, .width = p->outline.width};
    hn_canvas_line(p->c, xy, n, &solid);
}

static void draw_damper(const hn_pen *p, const hn_shape *shape) {
    static const double rod[] = {0, 0, 0.5, 0}, piston[] = {0.5, -0.38, 0.5, 0.38};
    static const double pot[] = {0.36, -0.55, 0.66, -0.55, 0.66, 0.55, 0.36, 0.55},
                        tail[] = {0.66, 0, 1, 0};
    double a[2], b[2], u[2];
    hn_pen_at(p, shape->p, a);
    hn_pen_at(p, shape->q, b);
    const double length = hn_pen_direction(a, b, u);
    draw_local(p, a, u, length, rod, 2);
    draw_local(p, a, u, length, piston, 2);
    draw_local(p, a, u, length, pot, 4);
    draw_local(p, a, u, length, tail, 2);
}

/// Returns whether n corners lie on a circle, as many as a scene takes in place of one; `centre` is
/// its middle.
static bool is_circle(const double *corner, int n, double centre[3]) {
    double least = HUGE_VAL, most = 0;
    for (int k = 0; k < 3; k++) {
        centre[k] = 0;
        for (int i = 0; i < n; i++) {
            centre[k] += corner[3 * i + k] / n;
        }
    }
    for (int i = 0; i < n; i++) {
        const double *x = corner + 3 * i;
        const double r = hypot(hypot(x[0] - centre[0], x[1] - centre[1]), x[2] - centre[2]);
        least = fmin(least, r);
        most = fmax(most, r);
    }
    return n >= ROUND && n * ARC_STEPS <= MAX_POLYGON && most - least < 0.01 * most;
}

/// The point of the circle at a share of the way from one corner to the next.
static void circle_point(const double *a, const double *b, const double centre[3], double share,
                         double out[3]) {
    double from[3], to[3], radius = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        from[k] = a[k] - centre[k];
        to[k] = from[k] + share * (b[k] - a[k]);
        radius = hypot(radius, from[k]);
        length = hypot(length, to[k]);
    }
    for (int k = 0; k < 3; k++) {
        out[k] = centre[k] + (length > 0 ? radius / length : 1) * to[k];
    }
}

static void draw_polygon(const hn_pen *p, const hn_shape *shape) {
    double xy[2 * MAX_POLYGON], centre[3], world[3];
    const double *corner = p->points + 3 * shape->p;
    HN_ASSERT(shape->n <= MAX_POLYGON);
    const int steps = is_circle(corner, shape->n, centre) ? ARC_STEPS : 1;
    for (int i = 0; i < shape->n * steps; i++) {
        const double *a = corner + 3 * (i / steps), *b = corner + 3 * ((i / steps + 1) % shape->n);
        circle_point(a, b, centre, (double)(i % steps) / steps, world);
        hn_sheet_pixel(p->s, steps > 1 ? world : a, xy + 2 * i);
    }
    if (shape->n >= 3) {
        hn_pen_outlined(p, xy, shape->n * steps);
    }
}

/// The symbol of a support lies in the picture, or in the plane of a mechanism seen at a slant:
/// `right` and `down` are a length of 1 px as they are seen.
static void find_upright(const hn_sheet *s, double right[2], double down[2]) {
    right[0] = down[1] = 1;
    right[1] = down[0] = 0;
    if (s->is_slanted) {
        for (int k = 0; k < 2; k++) {
            right[k] = s->plane[0][k];
            down[k] = -s->plane[1][k];
        }
    }
}

static double support_size(const hn_sheet *s) {
    return 1.25 * s->bar;
}

static void draw_ground(const hn_pen *p, const hn_shape *shape) {
    double a[2], right[2], down[2], triangle[6];
    const double size = support_size(p->s);
    hn_pen_at(p, shape->p, a);
    find_upright(p->s, right, down);
    const double foot[2] = {a[0] + size * down[0], a[1] + size * down[1]};
    for (int k = 0; k < 2; k++) {
        triangle[k] = a[k];
        triangle[2 + k] = foot[k] + 0.75 * size * right[k];
        triangle[4 + k] = foot[k] - 0.75 * size * right[k];
    }
    hn_pen_outlined(p, triangle, 3);
    hn_canvas_hatch_plane(p->c, foot[0], foot[1], 2.6 * size, right, down, &p->outline);
}

/// Returns how far the view reaches from a along u (both signs), so that a guide spans it.
static double reach(const hn_sheet *s, const double a[2], const double u[2]) {
    double most = 0;
    for (int i = 0; i < 4; i++) {
        const double corner[2] = {s->view[i % 2], s->view[2 + i / 2]};
        double xy[2];
        hn_sheet_place(s, corner, xy);
        most = fmax(most, (xy[0] - a[0]) * u[0] + (xy[1] - a[1]) * u[1]);
    }
    return most;
}

/// A guide on the sheet: from one end of its hatched rail to the other, and to the other rail.
typedef struct guide {
    double u[2], away[2]; ///< along, and from the slider to the hatching
    double middle[2], length, off;
} guide;

static guide lay_guide(const hn_sheet *s, const double *p, const double *q, double width) {
    guide g;
    double a[2], b[2];
    hn_sheet_pixel(s, p, a);
    hn_sheet_pixel(s, q, b);
    hn_pen_direction(a, b, g.u);
    find_across(s, p, q, g.away);
    const double back[2] = {-g.u[0], -g.u[1]};
    const double ahead = reach(s, a, g.u) + 1.5 * width, behind = reach(s, a, back) + 1.5 * width;
    g.off = 1.02 * width;
    g.length = ahead + behind;
    for (int k = 0; k < 2; k++) {
        g.middle[k] = a[k] + (ahead - behind) / 2 * g.u[k];
    }
    return g;
}

static void draw_guide(const hn_pen *p, const hn_shape *shape) {
    const double *points = p->points;
    const guide g =
        lay_guide(p->s, points + 3 * shape->p, points + 3 * shape->q, hn_pen_bar_width(p, shape));

    // one rail is hatched as ground, the other a mere line
    hn_stroke rail = p->outline;
    rail.width *= RAIL;
    hn_canvas_hatch_plane(p->c, g.middle[0] + g.off * g.away[0], g.middle[1] + g.off * g.away[1],
                          g.length, g.u, g.away, &rail);
    const double x = g.middle[0] - g.off * g.away[0], y = g.middle[1] - g.off * g.away[1];
    const double half = g.length / 2;
    hn_canvas_segment(p->c, x - half * g.u[0], y - half * g.u[1], x + half * g.u[0],
                      y + half * g.u[1], &rail);
}

/// The pins of a spring or damper: neither end hangs in the air.
static void draw_ends(const hn_pen *p, const hn_shape *shape) {
    hn_shape end = *shape;
    hn_joint_draw(p, &end);
    end.p = shape->q;
    hn_joint_draw(p, &end);
}

// ---- one table ----

// HN_SHAPE_ARROW and HN_SHAPE_TRACE are not here: what they show comes with the pose and the
// options
typedef struct shape_row {
    hn_shape_kind kind;
    int order; ///< what is drawn first within a pose: guides and bars beneath pivots
    int belongs_to_ground;
    void (*draw)(const hn_pen *p, const hn_shape *shape);
} shape_row;

static const shape_row rows[] = {
    {HN_SHAPE_GUIDE, 0, 1, draw_guide},     {HN_SHAPE_GROUND, 1, 1, draw_ground},
    {HN_SHAPE_POLYGON, 0, 0, draw_polygon}, {HN_SHAPE_SPRING, 1, 0, draw_spring},
    {HN_SHAPE_DAMPER, 1, 0, draw_damper},   {HN_SHAPE_SLIDER, 2, 0, draw_slider},
    {HN_SHAPE_BAR, 3, 0, draw_bar},         {HN_SHAPE_PIVOT, 4, 0, hn_joint_draw},
    {HN_SHAPE_GROUND, 4, 0, hn_joint_draw}, // its pin, above the bars
    {HN_SHAPE_SPRING, 4, 0, draw_ends},     {HN_SHAPE_DAMPER, 4, 0, draw_ends},
};
enum { N_ROWS = sizeof rows / sizeof *rows, N_ORDERS = HN_SHAPE_ORDERS };

static const shape_row *row_of(hn_shape_kind kind, int order, int ground) {
    for (int k = 0; k < N_ROWS; k++) {
        if (rows[k].kind == kind && rows[k].order == order && rows[k].belongs_to_ground == ground) {
            return &rows[k];
        }
    }
    return NULL;
}

/// Returns how far a shape's middle lies towards the viewer.
static double middle_depth(const hn_pen *p, const hn_shape *shape) {
    const int ends[2] = {shape->p,
                         shape->kind == HN_SHAPE_POLYGON || shape->q < 0 ? shape->p : shape->q};
    double depth = 0;
    for (int e = 0; e < 2; e++) {
        for (int i = 0; i < 3; i++) {
            depth += 0.5 * p->s->look.toward[i] * p->points[3 * ends[e] + i];
        }
    }
    return depth;
}

/// A pin is seen before every bar that it holds.
static double pin_depth(const hn_pen *p, const hn_drawing *d, const hn_shape *pin) {
    double depth = middle_depth(p, pin);
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *bar = &d->shapes[i];
        if (bar->kind == HN_SHAPE_BAR &&
            (hn_pen_same_place(p, bar->p, pin->p) || hn_pen_same_place(p, bar->q, pin->p))) {
            depth = fmax(depth, middle_depth(p, bar));
        }
    }
    return depth + PIN_NEARER * p->s->scale_bar;
}

/// Shell sort: stable enough, in place, and a drawing has hundreds of shapes, not millions.
static void sort_by_depth(int *shapes, double *depth, int n) {
    for (int gap = n / 2; gap > 0; gap /= 2) {
        for (int i = gap; i < n; i++) {
            const int shape = shapes[i];
            const double d = depth[i];
            int k = i;
            for (; k >= gap && depth[k - gap] > d; k -= gap) {
                shapes[k] = shapes[k - gap];
                depth[k] = depth[k - gap];
            }
            shapes[k] = shape;
            depth[k] = d;
        }
    }
}

/// The pen for a shape at a depth, 0 (farthest) to 1: what is far is paler.
static hn_pen at_depth(const hn_pen *p, double near) {
    hn_pen here = *p;
    const hn_theme theme = hn_canvas_theme(p->c);
    if (p->has_fill) {
        const double share = FARTHEST + (1 - FARTHEST) * near;
        here.fill.rgb = hn_tint(theme, p->fill.rgb, share);
        here.outline.paint.rgb = hn_tint(theme, p->outline.paint.rgb, share);
    }
    return here;
}

/// Shape and order in one number, so that they are sorted together.
static void draw_by_depth(const hn_pen *p, const hn_drawing *d, int ground) {
    int n = 0;
    for (int i = 0; i < d->n_shapes; i++) {
        for (int order = 0; order < N_ORDERS; order++) {
            if (row_of(d->shapes[i].kind, order, ground)) {
                p->s->depth[n] = order == N_ORDERS - 1 ? pin_depth(p, d, &d->shapes[i])
                                                       : middle_depth(p, &d->shapes[i]);
                p->s->shapes[n++] = i * N_ORDERS + order;
            }
        }
    }
    sort_by_depth(p->s->shapes, p->s->depth, n);
    for (int k = 0; k < n; k++) {
        const hn_shape *shape = &d->shapes[p->s->shapes[k] / N_ORDERS];
        const double back = p->s->depth[0], deep = p->s->depth[n - 1] - back;
        const bool flat = deep <= 2 * PIN_NEARER * p->s->scale_bar; // a plane seen from behind
        const double near = flat ? 1 : (p->s->depth[k] - back) / deep;
        const hn_pen here = at_depth(p, near);
        row_of(shape->kind, p->s->shapes[k] % N_ORDERS, ground)->draw(&here, shape);
    }
}

/// The corners of a rim: bars of the ground that follow each other round a circle.
typedef struct rim {
    int n;
    double corner[MAX_POLYGON / ARC_STEPS][3], centre[3];
    const hn_shape *bar;
} rim;

/// Finds the bars of the ground, as of a ring gear, that are a circle in pieces. False: they are
/// not.
static bool find_rim(const hn_pen *p, const hn_drawing *d, rim *out) {
    out->n = 0;
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *bar = &d->shapes[i];
        if (bar->kind == HN_SHAPE_BAR && bar->body == HN_GROUND) {
            if (out->n == MAX_POLYGON / ARC_STEPS ||
                (out->n > 0 && !hn_pen_same_place(p, out->bar->q, bar->p))) {
                return false;
            }
            out->bar = bar;
            memcpy(out->corner[out->n++], p->points + 3 * bar->p, sizeof *out->corner);
        }
    }
    return is_circle(out->corner[0], out->n, out->centre);
}

/// Draws a circle with the centre of the rim, so many pixels outside of it.
static void draw_rim_line(const hn_pen *p, const rim *r, double beyond, const hn_stroke *stroke) {
    double xy[2 * MAX_POLYGON], at[3], radius = 0;
    for (int i = 0; i < r->n * ARC_STEPS; i++) {
        const double *a = r->corner[i / ARC_STEPS], *b = r->corner[(i / ARC_STEPS + 1) % r->n];
        circle_point(a, b, r->centre, (double)(i % ARC_STEPS) / ARC_STEPS, at);
        radius = hypot(hypot(at[0] - r->centre[0], at[1] - r->centre[1]), at[2] - r->centre[2]);
        for (int k = 0; k < 3; k++) {
            at[k] += beyond / (p->s->scale * radius) * (at[k] - r->centre[k]);
        }
        hn_sheet_pixel(p->s, at, xy + 2 * i);
    }
    hn_canvas_line(p->c, xy, r->n * ARC_STEPS, stroke);
}

static void draw_rim(const hn_pen *p, const rim *r) {
    const double width = hn_pen_bar_width(p, r->bar);
    hn_stroke line = p->outline;
    line.closed = 1;
    if (p->has_fill) {
        hn_stroke band = line;
        band.n_dash = 0;
        band.paint = p->fill;
        band.width = width;
        draw_rim_line(p, r, 0, &band);
    }
    draw_rim_line(p, r, -width / 2, &line);
    draw_rim_line(p, r, width / 2, &line);
}

static void draw_shapes(const hn_pen *p, const hn_drawing *d, int ground) {
    rim r;
    const bool has_rim = !p->s->in_space && find_rim(p, d, &r);
    if (has_rim && !ground) {
        draw_rim(p, &r);
    }
    if (p->s->in_space) {
        draw_by_depth(p, d, ground);
        return;
    }
    for (int order = 0; order < N_ORDERS; order++) {
        for (int i = 0; i < d->n_shapes; i++) {
            const hn_shape *shape = &d->shapes[i];
            const bool of_rim = has_rim && shape->kind == HN_SHAPE_BAR && shape->body == HN_GROUND;
            const shape_row *row = row_of(shape->kind, order, ground);
            if (row && !of_rim) {
                row->draw(p, shape);
            }
        }
    }
}

void hn_snapshot_ground(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(c));
    const hn_pen p = {.c = c,
                      .s = s,
                      .d = d,
                      .points = pose->points,
                      .outline = hn_stroke_solid(surface->muted, GROUND_LINE * s->line),
                      .fill = hn_paint_solid(surface->raised),
                      .has_fill = 1};
    draw_shapes(&p, d, 1);
}

/// A strip of hatching on one side of a line through `middle`.
static void keep_off_hatching(hn_label_places *placed, const double middle[2], double half_length,
                              const double along[2], const double away[2], double depth) {
    double ends[2][2];
    for (int k = 0; k < 2; k++) {
        const double at = middle[k] + 0.5 * depth * away[k];
        ends[0][k] = at - half_length * along[k];
        ends[1][k] = at + half_length * along[k];
    }
    hn_label_keep_off_strip(placed, ends[0], ends[1], 0.5 * depth);
}

void hn_snapshot_hatching(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                          hn_label_places *placed) {
    const double depth = hn_canvas_hatch_depth(GROUND_LINE * s->line), size = support_size(s);
    double a[2], right[2], down[2];
    find_upright(s, right, down);
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *shape = &d->shapes[i];
        const double *p = pose->points + 3 * shape->p;
        if (shape->kind == HN_SHAPE_GROUND) {
            hn_sheet_pixel(s, p, a);
            const double foot[2] = {a[0] + size * down[0], a[1] + size * down[1]};
            keep_off_hatching(placed, foot, 1.3 * size, right, down, depth);
        } else if (shape->kind == HN_SHAPE_GUIDE) {
            const double width = shape->width > 0 ? fmax(4, s->scale * shape->width) : s->bar;
            const guide g = lay_guide(s, p, pose->points + 3 * shape->q, width);
            const double rail[2] = {g.middle[0] + g.off * g.away[0],
                                    g.middle[1] + g.off * g.away[1]};
            keep_off_hatching(placed, rail, g.length / 2, g.u, g.away, RAIL * depth);
        }
    }
}

/// Draws the n points from `first` on; what is not finite is left out by the line.
static void draw_path(hn_canvas *c, const hn_sheet *s, const hn_snapshot_pose *pose, int first,
                      int n_points, const hn_stroke *stroke) {
    double xy[2 * TRACE_PIECE];
    for (int from = 0; from + 1 < n_points; from += TRACE_PIECE - 1) { // pieces share their ends
        const int left = n_points - from, n = left < TRACE_PIECE ? left : TRACE_PIECE;
        for (int i = 0; i < n; i++) {
            hn_sheet_pixel(s, pose->trace + 3 * (first + from + i), xy + 2 * i);
        }
        hn_canvas_line(c, xy, n, stroke);
    }
}

static void draw_traces(hn_canvas *c, const hn_sheet *s, const hn_snapshot_pose *pose,
                        int n_traces) {
    const int paths = n_traces > 0 ? n_traces : 1, n = pose->n_trace / paths;
    for (int k = 0; k < paths; k++) {
        const hn_stroke stroke = hn_trace_stroke(hn_canvas_theme(c), pose->slot, s->line, k);
        draw_path(c, s, pose, k * n, n, &stroke);
    }
}

void hn_snapshot_pose_draw(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                           const hn_snapshot_pose *pose, bool is_selected, int n_traces) {
    const hn_theme theme = hn_canvas_theme(c);
    hn_pen p = {.c = c,
                .s = s,
                .d = d,
                .points = pose->points,
                .outline = hn_slot_stroke(theme, pose->slot, s->line)};
    p.is_reference = pose->slot == HN_LOOK_REFERENCE && !is_selected;
    p.has_fill = is_selected;
    p.fill = hn_paint_solid(hn_tint(theme, p.outline.paint.rgb, SELECTED_TINT));
    if (is_selected || pose->faint) {
        p.outline.n_dash = 0;
    } else if (p.is_reference) {
        p.outline.width = 0.75 * s->line;
    }
    hn_canvas_begin_layer(c, pose->faint                     ? FAINT_OPACITY
                             : is_selected || p.is_reference ? 1
                                                             : GHOST_OPACITY);
    draw_traces(c, s, pose, n_traces);
    draw_shapes(&p, d, 0);
    hn_canvas_end_layer(c);
}
