// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_ANGLES_H
#define HN_RENDER_SNAPSHOT_ANGLES_H
// Angles of coordinates on a sheet, as a textbook draws them. Inside render/ only.

#include "render/snapshot_places.h"
#include "render/snapshot_sheet.h"

/// Draws each angle of opts.angles at its pivot: a dashed line where the bar would lie at angle 0,
/// an arc with an arrow from there to the bar, and the name with the value within a turn and the
/// number of whole turns. If one value has no room, all names stand alone and the legend lists the
/// values; it lists those of angles without an arc in any case. The texts join those that later
/// ones keep off.
void hn_snapshot_angles(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed);
#endif
