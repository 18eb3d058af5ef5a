// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_CANVAS_H
#define HN_RENDER_CANVAS_H
// A small drawing surface: shapes are recorded as triangles, then painted off the screen by OSMesa,
// or by the built-in renderer where OSMesa is missing (or HOLONOM_RENDERER is "built-in"), tile by
// tile at four times the size in both directions and averaged down, so that every edge has
// 17 levels and memory stays small.
//
// Coordinates are pixels, x right, y down, (0, 0) the upper left corner. Colours are 0xRRGGBB,
// mixed as sRGB values. One shape never covers itself twice: a translucent line that crosses itself
// has one shade. A layer (begin ... end) holds several shapes to the same rule, the last drawn on
// top, so that a whole mechanism can be shown at 60 %.
//
// Drawing calls have no result. When memory runs out the canvas keeps that, and painting fails.

#include "base/diag.h"
#include "base/interrupt.h"
#include "base/strbuf.h"
#include "render/look.h"

#include <stdbool.h>

enum { HN_CANVAS_MIN = 16, HN_CANVAS_MAX = 4096, HN_CANVAS_SAMPLES = 4 };

typedef struct hn_canvas hn_canvas;

/// A sheet of the theme's paper, width x height pixels in HN_CANVAS_MIN..HN_CANVAS_MAX. Fails:
/// HN_ERR_LIMIT (pointer "/width" or "/height"), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_canvas_create(int width, int height, hn_theme theme, hn_canvas **out,
                                         hn_diag *diag);
void hn_canvas_free(hn_canvas *c); ///< NULL is legal
int hn_canvas_width(const hn_canvas *c);
int hn_canvas_height(const hn_canvas *c);
hn_theme hn_canvas_theme(const hn_canvas *c);

typedef struct hn_paint {
    uint32_t rgb;
    double alpha; ///< 0..1
} hn_paint;

typedef struct hn_stroke {
    hn_paint paint;
    double width;       ///< [px]
    int closed;         ///< the last point is joined to the first
    int n_dash;         ///< 0: a full line
    const double *dash; ///< on, off, ... as seen, round ends included [px]
} hn_stroke;

/// One opaque colour, 0xRRGGBB: a filling, and a line of this width [px].
hn_paint hn_paint_solid(uint32_t rgb);
hn_stroke hn_stroke_solid(uint32_t rgb, double width);

// ---- shapes ----
// xy holds n points x, y; points that are not finite are left out with their segments

/// A line through n points with round ends and corners.
void hn_canvas_line(hn_canvas *c, const double *xy, int n, const hn_stroke *stroke);
void hn_canvas_segment(hn_canvas *c, double x0, double y0, double x1, double y1,
                       const hn_stroke *stroke);
void hn_canvas_disc(hn_canvas *c, double x, double y, double radius, hn_paint paint);
void hn_canvas_ring(hn_canvas *c, double x, double y, double radius, const hn_stroke *stroke);
/// A part of a circle from one angle to another [rad], counted clockwise as seen from the x axis;
/// `from` may be larger.
void hn_canvas_arc(hn_canvas *c, double x, double y, double radius, double from, double to,
                   const hn_stroke *stroke);
/// A simple polygon, convex or not, either sense; n >= 3.
void hn_canvas_polygon(hn_canvas *c, const double *xy, int n, hn_paint paint);
/// The outline of a bar with round ends, `width` across, from one point to the other: writes at
/// most HN_CAPSULE_POINTS points, returns how many. For hn_canvas_polygon and hn_canvas_line
/// (closed).
enum { HN_CAPSULE_POINTS = 34 };
int hn_canvas_capsule(double x0, double y0, double x1, double y1, double width,
                      double xy[2 * HN_CAPSULE_POINTS]);
/// An arrow with its tip at (x1, y1); `head` is the length of the head [px].
void hn_canvas_arrow(hn_canvas *c, double x0, double y0, double x1, double y1, double head,
                     const hn_stroke *stroke);
/// A ground line of the given length through (x, y), its normal at `angle` (radians, counted
/// clockwise from straight down), strokes slanting away on that side.
void hn_canvas_hatch(hn_canvas *c, double x, double y, double length, double angle,
                     const hn_stroke *stroke);
/// The same in a plane seen at a slant: `along` and `away` are a length of 1 px along the line and
/// away from it, as they are seen.
void hn_canvas_hatch_plane(hn_canvas *c, double x, double y, double length, const double along[2],
                           const double away[2], const hn_stroke *stroke);
/// How deep the hatching of a stroke of this width is [px].
double hn_canvas_hatch_depth(double width);
/// The marker of a method.
void hn_canvas_marker(hn_canvas *c, hn_marker marker, double x, double y, double size,
                      hn_paint paint);

typedef enum hn_align { HN_ALIGN_LEFT, HN_ALIGN_CENTRE, HN_ALIGN_RIGHT } hn_align;
/// One line of text, baseline at y; `size` is the font size [px], capitals are 0.7 of it.
void hn_canvas_text(hn_canvas *c, double x, double y, double size, hn_align align, hn_paint paint,
                    const char *utf8);
double hn_canvas_text_width(double size, const char *utf8);

// ---- grouping ----
void hn_canvas_begin_layer(hn_canvas *c, double opacity); ///< layers do not nest
void hn_canvas_end_layer(hn_canvas *c);
/// Shapes from now on are seen inside this rectangle only (whole pixels).
void hn_canvas_clip(hn_canvas *c, int x, int y, int width, int height);
void hn_canvas_unclip(hn_canvas *c);

// ---- painting: may be called more than once, and from several threads: they take turns ----

/// Painting and writing ask `interrupt` every few hundredths of a second, and fail with
/// HN_ERR_STOPPED when it ends them. NULL: they go on to their end. It must outlive the canvas.
void hn_canvas_interrupt(hn_canvas *c, const hn_interrupt *interrupt);

typedef enum hn_renderer {
    HN_RENDERER_AUTO, ///< OSMesa where it is installed
    HN_RENDERER_OSMESA,
    HN_RENDERER_BUILT_IN,
    HN_RENDERER_COUNT
} hn_renderer;
/// Chooses the renderer of the whole program, in place of HOLONOM_RENDERER. Before the first
/// picture, from one thread.
void hn_canvas_choose_renderer(hn_renderer renderer);
/// Returns the name of the renderer: "OSMesa" or "built-in".
const char *hn_canvas_renderer(void);
/// rgb: 3 * width * height bytes, row by row from the top. Fails: HN_ERR_MEMORY; HN_ERR_UNSUPPORTED
/// when OSMesa is there and cannot give a context; HN_ERR_INTERNAL when GL reports a fault;
/// HN_ERR_STOPPED.
HN_MUST_CHECK hn_status hn_canvas_paint(const hn_canvas *c, unsigned char *rgb, hn_diag *diag);
/// Appends the bytes of a PNG file.
HN_MUST_CHECK hn_status hn_canvas_png(const hn_canvas *c, hn_strbuf *png, hn_diag *diag);

#endif
