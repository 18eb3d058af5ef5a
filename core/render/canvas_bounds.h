// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_CANVAS_BOUNDS_H
#define HN_RENDER_CANVAS_BOUNDS_H
// Boxes around the shapes of a canvas, by which a tile leaves out what lies beside it. For the
// files of the canvas alone.

#include "render/canvas_record.h"

#include <stdbool.h>

/// A box around points [px]: least x, y, largest x, y.
typedef struct hn_bounds {
    float low[2], high[2];
} hn_bounds;

/// Returns the box around n >= 1 points x, y.
hn_bounds hn_bounds_of(const float *xy, int n);
/// Returns the boxes of all shapes of the canvas, for free(); that of a shape without a vertex is
/// not set. NULL: no memory.
hn_bounds *hn_bounds_of_shapes(const hn_canvas *c);
/// Returns whether a box lies beside the square of `side` pixels at (x0, y0), further than a pixel
/// away: what is in it takes no sample there.
bool hn_bounds_is_beside(hn_bounds box, int x0, int y0, int side);
#endif
