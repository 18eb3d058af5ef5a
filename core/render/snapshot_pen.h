// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_PEN_H
#define HN_RENDER_SNAPSHOT_PEN_H
// What every shape of a pose is drawn with. Inside render/ only.

#include "render/snapshot_sheet.h"

#include <stdbool.h>

/// Describes how one pose is drawn: colours of outline and fill, and whether it is a mere line.
typedef struct hn_pen {
    hn_canvas *c;
    const hn_sheet *s;
    const hn_drawing *d;
    const double *points; ///< world
    hn_stroke outline;
    hn_paint fill;
    int has_fill, is_reference;
} hn_pen;

void hn_pen_at(const hn_pen *p, int point, double out[2]);       ///< where a point is [pixels]
double hn_pen_bar_width(const hn_pen *p, const hn_shape *shape); ///< [pixels]

/// Returns whether two points are one, within a thousandth of the scale bar.
bool hn_pen_same_place(const hn_pen *p, int a, int b);
/// Unit vector from a to b in pixels, (1, 0) where they coincide; returns the distance.
double hn_pen_direction(const double a[2], const double b[2], double out[2]);
/// Draws a polygon of n corners, filled where the pen fills.
void hn_pen_outlined(const hn_pen *p, const double *xy, int n);

#endif
