// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_joints.h"

#include <math.h>
#include <stdbool.h>

/// The angle [rad, clockwise from x] at which the bar of the body that holds the joint leaves it,
/// or the other body's; a support is below. False: no such bar is there.
static bool find_bar(const hn_pen *p, const hn_shape *joint, bool of_holder, double *angle) {
    const bool on_ground = joint->kind == HN_SHAPE_GROUND;
    double longest = 0;
    if (of_holder && on_ground) {
        *angle = asin(1);
        return true;
    }
    for (int i = 0; i < p->d->n_shapes; i++) {
        const hn_shape *bar = &p->d->shapes[i];
        if (bar->kind != HN_SHAPE_BAR || (bar->body == joint->body) != of_holder) {
            continue;
        }
        for (int end = 0; end < 2; end++) {
            double a[2], b[2], u[2];
            hn_pen_at(p, end ? bar->q : bar->p, a);
            hn_pen_at(p, end ? bar->p : bar->q, b);
            const double length = hn_pen_direction(a, b, u);
            if (hn_pen_same_place(p, end ? bar->q : bar->p, joint->p) && length > longest) {
                longest = length;
                *angle = atan2(u[1], u[0]);
            }
        }
    }
    return longest > 0;
}

/// A ball in the socket of the body that holds it.
static void draw_ball(const hn_pen *p, const double a[2], const hn_shape *shape) {
    const double ball = fmax(3, 0.46 * p->s->bar), socket = ball + fmax(2.5, 2 * p->s->line);
    const hn_stroke wire = {.paint = p->outline.paint, .width = p->outline.width};
    const hn_stroke cup = {.paint = p->outline.paint, .width = 1.5 * p->outline.width};
    const hn_paint paper = hn_paint_solid(hn_surface_get(hn_canvas_theme(p->c))->paper);
    double holder = asin(1);
    if (!find_bar(p, shape, true, &holder)) {
        find_bar(p, shape, false, &holder);
    }
    if (p->has_fill) {
        hn_canvas_disc(p->c, a[0], a[1], socket, paper);
        hn_canvas_disc(p->c, a[0], a[1], ball, p->fill);
    }
    hn_canvas_ring(p->c, a[0], a[1], ball, &wire);
    hn_canvas_arc(p->c, a[0], a[1], socket, holder - 1.9, holder + 1.9, &cup);
}

/// Two forks and the cross between them.
static void draw_universal(const hn_pen *p, const double a[2], const hn_shape *shape) {
    const double fork = fmax(5, 0.85 * p->s->bar), pin = 0.8 * fork;
    const hn_stroke wire = {.paint = p->outline.paint, .width = p->outline.width};
    double angle[2] = {asin(1), -asin(1)};
    const bool held = find_bar(p, shape, true, &angle[0]);
    const bool holds = find_bar(p, shape, false, &angle[1]);
    angle[0] = !held && holds ? angle[1] + acos(-1) : angle[0];
    angle[1] = !holds ? angle[0] + acos(-1) : angle[1];
    if (p->has_fill) {
        hn_canvas_disc(p->c, a[0], a[1], fork,
                       hn_paint_solid(hn_surface_get(hn_canvas_theme(p->c))->paper));
    }

    // the pin of the first fork lies across it, the other across that
    for (int i = 0; i < 2; i++) {
        const double across = angle[0] + (i ? 0 : asin(1));
        hn_canvas_segment(p->c, a[0] - pin * cos(across), a[1] - pin * sin(across),
                          a[0] + pin * cos(across), a[1] + pin * sin(across), &wire);
        hn_canvas_arc(p->c, a[0], a[1], fork, angle[i] - 1.2, angle[i] + 1.2, &wire);
    }
}

void hn_joint_draw(const hn_pen *p, const hn_shape *shape) {
    if (p->is_reference) {
        return;
    }
    double a[2];
    if (shape->joint == HN_JOINT_SPHERICAL || shape->joint == HN_JOINT_UNIVERSAL) {
        hn_pen_at(p, shape->p, a);
        (shape->joint == HN_JOINT_SPHERICAL ? draw_ball : draw_universal)(p, a, shape);
        return;
    }
    hn_pen_at(p, shape->p, a);
    const hn_stroke ring = {.paint = p->outline.paint,
                            .width = p->has_fill ? p->s->line : 0.6 * p->s->line};
    const double r = fmax(2.5, 0.28 * p->s->bar);
    if (p->has_fill) {
        hn_canvas_disc(p->c, a[0], a[1], r,
                       hn_paint_solid(hn_surface_get(hn_canvas_theme(p->c))->paper));
    }
    hn_canvas_ring(p->c, a[0], a[1], r, &ring);
}
