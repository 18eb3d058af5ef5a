// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LABELS_H
#define HN_RENDER_SNAPSHOT_LABELS_H
// The names of points and joints, and the times of earlier poses. Each text gets the place with the
// most room among some around its point: off the mechanism, off the arrows and the other texts, and
// on the sheet. Inside render/ only.

#include "render/snapshot_loads.h"
#include "render/snapshot_places.h"
#include "render/snapshot_sheet.h"

/// Draws the names of the selected pose's points, off the texts placed before; also that of the
/// joint in the inset, and those of the joints whose forces have values, where no point has them.
/// The legend lists names without room.
void hn_snapshot_names(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, const hn_snapshot_opts *opts,
                       hn_label_places *placed);
/// Draws the time of each faint pose beside a point that has moved far.
void hn_snapshot_times(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, int n_poses, hn_label_places *placed);
#endif
