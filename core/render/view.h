// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_VIEW_H
#define HN_RENDER_VIEW_H
// The direction of view: a parallel projection of the world on a plane. Plane mechanisms are seen
// from the front (world x right, y up), mechanisms in space a little from the right and from above.
// Upwards is y, or z where gravity acts along -z.

#include "base/diag.h"

/// Unit vectors, right-handed: right cross up = toward the viewer.
typedef struct hn_view {
    double right[3], up[3], toward[3];
} hn_view;

/// The view from `azimuth` [rad] round the vertical, from the front (0) towards world x, and
/// `elevation` [rad] above the horizontal.
hn_view hn_view_look(double azimuth, double elevation);
hn_view hn_view_front(void);
/// The default view for a mechanism in space.
hn_view hn_view_space(void);
/// out: right and up components [m].
void hn_view_project(const hn_view *view, const double world[3], double out[2]);
/// The same view of a world whose z is upwards: its x stays to the right, its y goes away from the
/// viewer.
hn_view hn_view_z_up(hn_view view);
/// "front", "side", "top", "space", or azimuth and elevation in degrees: "35,22"; y upwards.
/// HN_ERR_INPUT with the reason in diag.
HN_MUST_CHECK hn_status hn_view_parse(const char *text, hn_view *out, hn_diag *diag);

#endif
