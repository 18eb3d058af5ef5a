// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LABELS_H
#define HN_RENDER_SNAPSHOT_LABELS_H
// Arrows of forces with their values, and the names of points. Each text gets the place with the
// most room among some around its point: off the mechanism, off the arrows and the other texts, and
// on the sheet. Inside render/ only.

#include "render/snapshot_sheet.h"

enum { HN_LABELS_PLACED = 128 };

/// Texts that have been placed: each a line, its middle and half its width [px].
typedef struct hn_label_places {
    int n;
    double at[HN_LABELS_PLACED][2], half[HN_LABELS_PLACED];
} hn_label_places;

/// Keeps later texts off this one.
void hn_label_remember(hn_label_places *placed, const double xy[2], double half);
/// Returns the force that the longest arrow stands for, seen in this view [unit of the loads]; 0
/// without loads.
double hn_snapshot_longest_load(const hn_sheet *s, const hn_snapshot_opts *opts);
/// Draws both for the selected pose, as opts says, off the texts placed before.
void hn_snapshot_labels(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed);
#endif
