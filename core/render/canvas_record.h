// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_CANVAS_RECORD_H
#define HN_RENDER_CANVAS_RECORD_H
// The recorded strokes and texts of a canvas. For the files of the canvas alone.

#include "render/canvas.h"

/// A stroked line, kept beside its triangles for vector graphics: n points from `first` of
/// canvas->pen_xy. It made `count` vertices from `vertex` on.
typedef struct hn_canvas_pen {
    int first, n, closed, vertex, count;
    float width; ///< [px]
} hn_canvas_pen;

/// One shape: `count` vertices from `first`, three for a triangle; the n_pens pens from `pen` on
/// made some of them.
typedef struct hn_canvas_shape {
    hn_paint paint;
    int first, count;
    int pen, n_pens;
    int clip[4]; ///< x0, y0, x1, y1 [px]
    int layer;
} hn_canvas_shape;

struct hn_canvas {
    int width, height;
    hn_theme theme;
    int failed; ///< memory ran out while recording
    const hn_interrupt *interrupt;
    int clip[4];

    float *xy; ///< 2 per vertex [px]
    int n_xy, cap_xy;
    float *pen_xy; ///< 2 per point [px]
    int n_pen_xy, cap_pen_xy;
    hn_canvas_pen *pens;
    int n_pens, cap_pens;
    hn_canvas_shape *shapes;
    int n_shapes, cap_shapes;
    double *layers; ///< opacity of each; a shape outside of any has one of its own
    int n_layers, cap_layers;
    int in_layer;
};

/// A shape is what is added between these two. Nothing is kept of an empty one.
void hn_record_begin(hn_canvas *c, hn_paint paint);
void hn_record_end(hn_canvas *c);
void hn_record_triangle(hn_canvas *c, const double a[2], const double b[2], const double d[2]);
void hn_record_disc(hn_canvas *c, double x, double y, double radius);
/// Keeps the line whose triangles were recorded from vertex `vertex` on. Points must be finite.
void hn_record_pen(hn_canvas *c, const double *xy, int n, int closed, double width, int vertex);

#endif
