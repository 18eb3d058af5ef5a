// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_SHAPES_H
#define HN_RENDER_SNAPSHOT_SHAPES_H
// The mechanism itself on a sheet. Inside render/ only.

#include "render/snapshot_places.h"
#include "render/snapshot_sheet.h"

#include <stdbool.h>

/// Ground, guides: what belongs to no pose, from the selected one.
void hn_snapshot_ground(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose);
/// Draws a pose and the n_traces paths that it carries.
void hn_snapshot_pose_draw(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                           const hn_snapshot_pose *pose, bool is_selected, int n_traces);
/// Keeps texts off the hatching of supports and guides.
void hn_snapshot_hatching(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                          hn_label_places *placed);

#endif
