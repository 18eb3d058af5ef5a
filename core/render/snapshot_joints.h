// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_JOINTS_H
#define HN_RENDER_SNAPSHOT_JOINTS_H
// Symbols of joints on a sheet, as ISO 3952 draws them. Inside render/ only.

#include "render/snapshot_pen.h"

/// Draws the symbol of a joint that turns: a pin, a ball or a universal joint. The reference, a
/// mere line, has none.
void hn_joint_draw(const hn_pen *p, const hn_shape *shape);

#endif
