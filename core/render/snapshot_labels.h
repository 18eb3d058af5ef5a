// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LABELS_H
#define HN_RENDER_SNAPSHOT_LABELS_H
// Arrows of forces with their values, and the names of points. Each text gets the place with the
// most room among some around its point: off the mechanism, off the arrows and the other texts, and
// on the sheet. Inside render/ only.

#include "render/snapshot_sheet.h"

/// Draws both for the selected pose, as opts says.
void hn_snapshot_labels(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts);
#endif
