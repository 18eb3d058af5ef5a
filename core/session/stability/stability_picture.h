// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_PICTURE_H
#define HN_SESSION_STABILITY_STABILITY_PICTURE_H
// A map as a PNG file, drawn as the SVG is.

#include "session/stability/stability.h"

/// Draws the map as PNG, in light colours. Fails: as hn_canvas_create() and hn_canvas_png().
HN_MUST_CHECK hn_status hn_map_png(hn_strbuf *png, const hn_map *map, hn_diag *diag);
#endif
