// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_MARKS_H
#define HN_RENDER_SNAPSHOT_MARKS_H
// The marker of each method on a sheet, and the list of everything that is drawn. Inside render/
// only.

#include "render/snapshot_labels.h"
#include "render/snapshot_sheet.h"

/// Draws the marker of each method on a bar of its pose, at places of their own, where there is
/// more than one method.
void hn_snapshot_markers(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                         const hn_snapshot_pose *poses, int n_poses);
/// Writes "primitives": a list of {"kind","pose","points":[[x, y, z], ...],"pixels":[[x, y], ...],
/// "labels"}, shape by shape of every pose that is drawn, [m] and [px], with "joint" where a symbol
/// is drawn; "traces", "loads" and "angles".
void hn_snapshot_primitives(hn_strbuf *b, const hn_sheet *s, const hn_drawing *d,
                            const hn_snapshot_pose *poses, int n_poses,
                            const hn_snapshot_opts *opts);
#endif
