// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LENGTHS_H
#define HN_RENDER_SNAPSHOT_LENGTHS_H
// Dimension lines of bars and of the ground, all in one unit. Inside render/ only.

#include "render/snapshot_places.h"

/// Chooses the unit of all lengths of the picture: metres if all are 0.1 m or more and one is 1 m
/// or more, millimetres where these suit.
void hn_snapshot_choose_unit(hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                             const hn_snapshot_opts *opts);
/// Draws the length of each bar beside it, with arrows between two extension lines, and that of the
/// ground between two supports. Many equal lengths are written once, with their number.
/// The values join the texts that later ones keep off; the legend lists those without room.
void hn_snapshot_lengths(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                         const hn_snapshot_pose *pose, hn_label_places *placed);
#endif
