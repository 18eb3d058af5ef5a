// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_pen.h"

#include <math.h>

void hn_pen_at(const hn_pen *p, int point, double out[2]) {
    hn_sheet_pixel(p->s, p->points + 3 * point, out);
}

double hn_pen_bar_width(const hn_pen *p, const hn_shape *shape) {
    return shape->width > 0 ? fmax(4, p->s->scale * shape->width) : p->s->bar;
}

double hn_pen_direction(const double a[2], const double b[2], double out[2]) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
    out[0] = length > 0 ? dx / length : 1;
    out[1] = length > 0 ? dy / length : 0;
    return length;
}

void hn_pen_outlined(const hn_pen *p, const double *xy, int n) {
    hn_stroke closed = p->outline;
    closed.closed = 1;
    if (p->has_fill) {
        hn_canvas_polygon(p->c, xy, n, p->fill);
    }
    hn_canvas_line(p->c, xy, n, &closed);
}

bool hn_pen_same_place(const hn_pen *p, int a, int b) {
    const double *x = p->points + 3 * a, *y = p->points + 3 * b;
    return fabs(x[0] - y[0]) + fabs(x[1] - y[1]) + fabs(x[2] - y[2]) < 1e-3 * p->s->scale_bar;
}
