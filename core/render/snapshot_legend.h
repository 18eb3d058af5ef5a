// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LEGEND_H
#define HN_RENDER_SNAPSHOT_LEGEND_H
// The legend of a sheet: a row for each method; keys to forces, earlier poses and paths; and what
// the drawing has no room for. Inside render/ only.

#include "render/snapshot_loads.h"
#include "render/snapshot_places.h"

/// Draws the text, cut to the width with an ellipsis where it is longer.
void hn_legend_text(hn_canvas *c, double x, double y, double size, double width, uint32_t colour,
                    const char *text);
/// The height that the legend takes with letters of the body text [px].
double hn_legend_height(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                        int n_poses, const hn_snapshot_opts *opts, const hn_label_places *placed);
/// Draws the legend, with smaller letters where it has not the room.
void hn_snapshot_legend(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *poses, int n_poses, const hn_snapshot_opts *opts,
                        const hn_label_places *placed);
/// The force of the arrow in the legend [unit of the loads]; 0 without loads.
double hn_legend_force(const hn_sheet *s, const hn_snapshot_opts *opts);
/// Writes "legend": the texts of the keys; and "force_scale": {"force","pixels"} or null.
void hn_legend_json(hn_strbuf *b, const hn_sheet *s, const hn_snapshot_pose *poses, int n_poses,
                    const hn_snapshot_opts *opts, const hn_label_places *placed);
#endif
