// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_LABELS_H
#define HN_RENDER_SNAPSHOT_LABELS_H
// Arrows of forces with their values, and the names of points. Each text gets the place with the
// most room among some around its point: off the mechanism, off the arrows and the other texts, and
// on the sheet. A value that stands away from its arrow is tied to it by a thin line. Inside
// render/ only.

#include "base/units.h"
#include "render/snapshot_sheet.h"

enum { HN_LABELS_PLACED = 128, HN_LABEL_ARROWS = 64 };

/// Texts that have been placed: each a line, its middle and half its width [px]; and lines that
/// texts keep off: arrows of forces, which are drawn later, and dimension lines.
typedef struct hn_label_places {
    int n;
    double at[HN_LABELS_PLACED][2], half[HN_LABELS_PLACED];
    int n_lines;
    double line[2 * HN_LABEL_ARROWS][2][2]; ///< both ends [px]
} hn_label_places;

/// The arrow of a force and its value [px].
typedef struct hn_load_mark {
    double tail[2], tip[2];
    double text[2]; ///< middle of the value
    double half;    ///< of the width of the value
    char value[HN_SI_TEXT];
} hn_load_mark;

/// Keeps later texts off this one.
void hn_label_remember(hn_label_places *placed, const double xy[2], double half);
/// Keeps later texts off a line.
void hn_label_keep_off_line(hn_label_places *placed, const double line[2][2]);
/// Keeps later texts off the arrows of opts.loads.
void hn_label_keep_off_loads(const hn_sheet *s, const hn_snapshot_pose *pose,
                             const hn_snapshot_opts *opts, hn_label_places *placed);
/// The room between a line of text and the texts and lines so far [px]; below 0 it lies on one.
double hn_label_room(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                     double half);
/// The same, and the room to the bars, springs and supports of the mechanism and to the edge of the
/// drawing's part of the sheet.
double hn_label_room_of_all(const hn_sheet *s, const hn_drawing *d, const double *points,
                            const hn_label_places *placed, const double xy[2], double half);
/// Lays the arrows of opts.loads that have a length in this view, at most HN_LABEL_ARROWS, and
/// finds a place for the value of each; returns how many there are.
int hn_load_marks_place(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                        const hn_snapshot_opts *opts, hn_label_places *placed,
                        hn_load_mark out[HN_LABEL_ARROWS]);
/// Returns the force that the longest arrow stands for, seen in this view [unit of the loads]; 0
/// without loads.
double hn_snapshot_longest_load(const hn_sheet *s, const hn_snapshot_opts *opts);
/// Draws both for the selected pose, as opts says, off the texts placed before.
void hn_snapshot_labels(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *pose, const hn_snapshot_opts *opts,
                        hn_label_places *placed);
#endif
