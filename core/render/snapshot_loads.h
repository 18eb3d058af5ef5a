// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LOADS_H
#define HN_RENDER_SNAPSHOT_LOADS_H
// Arrows of forces, all to one scale, with their values or, in a crowded drawing, with numbers that
// the legend explains. Inside render/ only.

#include "base/units.h"
#include "render/snapshot_places.h"

enum { HN_LABEL_ARROWS = 64 };

/// The arrow of a force and its text [px].
typedef struct hn_load_mark {
    int load; ///< of opts.loads
    double tail[2], tip[2];
    bool is_short;  ///< the arrow is longer than the force, so that it is seen
    double text[2]; ///< middle of the text
    double half;    ///< of the width of the text
    bool placed;    ///< the text has a free place
    char value[HN_SI_TEXT];
} hn_load_mark;

/// Keeps later texts off the arrows of opts.loads.
void hn_label_keep_off_loads(const hn_sheet *s, const hn_snapshot_pose *pose,
                             const hn_snapshot_opts *opts, hn_label_places *placed);
/// Lays the arrows of opts.loads that have a length in this view, at most HN_LABEL_ARROWS, and
/// finds a place for the value of each; returns how many there are. If there are many, or a value
/// has no free place, the texts are numbers and the rows of `placed` say what they stand for.
int hn_load_marks_place(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                        const hn_snapshot_opts *opts, hn_label_places *placed,
                        hn_load_mark out[HN_LABEL_ARROWS]);
/// Draws the arrows of opts.loads with their texts.
void hn_snapshot_loads(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                       hn_label_places *placed);
/// Draws an arrow that is longer than its force: a dot at its tail.
void hn_load_short_arrow(hn_canvas *c, const hn_sheet *s, const double tail[2],
                         const double tip[2]);
/// The length of an arrow that is longer than its force [px].
double hn_load_short_length(const hn_sheet *s);
/// Returns the force that the longest arrow stands for, seen in this view [unit of the loads]; 0
/// without loads.
double hn_snapshot_longest_load(const hn_sheet *s, const hn_snapshot_opts *opts);
/// The length of an arrow for a force of 1 [px]; 0 without loads.
double hn_load_scale(const hn_sheet *s, const hn_snapshot_opts *opts);
#endif
