// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_RASTER_H
#define HN_RENDER_RASTER_H
// The built-in renderer: paints a canvas without any library, for machines without OSMesa. Tiles,
// samples and layers are those of OSMesa's painting (canvas_paint.c); a sample on the very edge of
// a triangle may fall to the other side, so that pixels differ by a level or two there.

#include "render/canvas.h"

/// rgb: 3 * width * height bytes, row by row from the top. Fails: HN_ERR_MEMORY,
/// HN_ERR_STOPPED by the interrupt of the canvas.
HN_MUST_CHECK hn_status hn_raster_paint(const hn_canvas *c, unsigned char *rgb, hn_diag *diag);
#endif
