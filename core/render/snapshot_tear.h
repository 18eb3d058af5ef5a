// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_TEAR_H
#define HN_RENDER_SNAPSHOT_TEAR_H
// The gaps of cut joints on a sheet. Inside render/ only.

#include "render/snapshot_sheet.h"

/// Red segments in place, and the inset.
void hn_snapshot_tears(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, int n_poses);

#endif
