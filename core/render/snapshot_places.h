// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_PLACES_H
#define HN_RENDER_SNAPSHOT_PLACES_H
// The texts of a drawing and what they keep off: each other, hatching, arrows, dimension lines and
// the mechanism. A text that has no free place is not drawn; the legend lists it. At most
// HN_LABELS_PLACED texts are placed, so that the time they take grows with the mechanism, and not
// with its square. Inside render/ only.

#include "render/snapshot_sheet.h"

enum {
    HN_LABELS_PLACED = 160,
    HN_LABEL_LINES = 512,
    HN_LABEL_STRIPS = 48,
    HN_LABEL_TEXT = 96,
    HN_LABEL_ROWS = 96
};

/// The kinds of text in a drawing.
typedef enum hn_label_kind {
    HN_LABEL_NAME,
    HN_LABEL_FORCE,
    HN_LABEL_LENGTH,
    HN_LABEL_ANGLE,
    HN_LABEL_TIME,
    HN_LABEL_SHEET, ///< the scale bar and the triad of axes
    HN_LABEL_KINDS
} hn_label_kind;

/// Texts that have been placed: each a line, its middle and half its width [px]; lines that texts
/// keep off where they can; hatching, which they keep off in any case; and the texts that stand in
/// the legend.
typedef struct hn_label_places {
    int n;
    double at[HN_LABELS_PLACED][2], half[HN_LABELS_PLACED];
    hn_label_kind kind[HN_LABELS_PLACED];
    char text[HN_LABELS_PLACED][HN_LABEL_TEXT];
    int n_lines;
    double line[HN_LABEL_LINES][2][2]; ///< both ends [px]
    int n_strips;                      ///< hatching
    double strip[HN_LABEL_STRIPS][2][2], strip_half[HN_LABEL_STRIPS];
    int n_rows; ///< rows of the legend for what the drawing has no room for
    char row[HN_LABEL_ROWS][HN_LABEL_TEXT];
    bool numbered;  ///< the forces are numbered, and the rows give their values
    bool has_short; ///< an arrow is drawn longer than its force
} hn_label_places;

/// Keeps later texts off this one.
void hn_label_remember(hn_label_places *placed, hn_label_kind kind, const char *text,
                       const double xy[2], double half);
/// Keeps later texts off a line, where they have other room.
void hn_label_keep_off_line(hn_label_places *placed, const double line[2][2]);
/// Keeps later texts off a strip of hatching from one place to another.
void hn_label_keep_off_strip(hn_label_places *placed, const double from[2], const double to[2],
                             double half);
/// Keeps later texts off the scale bar and the triad of axes, which the sheet draws itself.
void hn_label_keep_off_corners(const hn_sheet *s, hn_label_places *placed);
/// Adds a row to the legend.
void hn_label_add_row(hn_label_places *placed, const char *text);

/// Returns whether a text of this half width around `xy` lies within the drawing, off the texts
/// placed before and off hatching.
bool hn_label_is_free(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                      double half);
/// Returns whether a text of this half width around `xy`, with the paper behind it, lies on a line
/// that texts keep off.
bool hn_label_is_on_line(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                         double half);
/// Returns whether the line from `xy` to `end` crosses a text that was placed before.
bool hn_label_is_crossed(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                         const double end[2]);
/// The room between a line of text and the texts and lines so far [px]; below 0 it lies on one.
double hn_label_room(const hn_sheet *s, const hn_label_places *placed, const double xy[2],
                     double half);
/// The same, and the room to the bars, springs and supports of the mechanism and to the edge of the
/// drawing's part of the sheet.
double hn_label_room_of_all(const hn_sheet *s, const hn_drawing *d, const double *points,
                            const hn_label_places *placed, const double xy[2], double half);
/// The room to the edge of the drawing's part of the sheet [px].
double hn_label_room_on_sheet(const hn_sheet *s, const double xy[2], double half);
/// From a line of text of this half width to a segment [px]; below 0 the segment crosses the text.
double hn_label_room_to_line(const double xy[2], double half, double height, const double a[2],
                             const double b[2]);
/// The segment that a shape covers on the sheet [px].
void hn_label_segment_of(const hn_sheet *s, const hn_shape *shape, const double *points,
                         double a[2], double b[2]);
/// Draws paper behind a line of text.
void hn_label_halo(hn_canvas *c, const hn_sheet *s, const double xy[2], double half);
/// Writes "labels": [{"text","kind","box":[left, top, right, bottom]}]; "hatching": a list of
/// {"from":[x, y],"to":[x, y],"half"}, strips of that half width, all in [px]; and "listed": the
/// texts that stand in the legend.
void hn_label_places_json(hn_strbuf *b, const hn_sheet *s, const hn_label_places *placed);
#endif
