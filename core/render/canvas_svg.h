// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_CANVAS_SVG_H
#define HN_RENDER_CANVAS_SVG_H
// A canvas as vector graphics: one path for each shape.

#include "render/canvas.h"

/// Appends an SVG file that shows n canvases of one size side by side, `columns` of them in a row.
/// `title` and `about` (may be NULL) are for readers who cannot see it. Lines and letters are
/// outlines, so no font is needed. If shapes of one translucent layer overlap, the upper one
/// lets the lower one through, which a painted canvas does not.
/// Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_canvas_svg(hn_strbuf *out, hn_canvas *const *canvases, int n,
                                      int columns, const char *title, const char *about,
                                      hn_diag *diag);
#endif
