// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_CURVE_FIGURE_H
#define HN_GRADE_CURVE_FIGURE_H
// The plot of a curve that a student reads: axes with round labels, so that no label gives the
// answer away, and one line.

#include "grade/parts/motion_curve.h"

/// The axis of y: round ends around the values. One with `high` > `low` in every case.
void hn_curve_axis(const hn_motion_curve *c, double *low, double *high);
/// As character cells, `columns` wide.
void hn_curve_text(hn_strbuf *b, const hn_motion_curve *c, const char *title, int columns);
/// As an SVG document without colours of its own: it takes the colour of the text around it.
void hn_curve_svg(hn_strbuf *b, const hn_motion_curve *c, const char *title);
/// As an SVG file with the paper, the lines and the lettering of a snapshot, which says how many
/// samples the line joins.
void hn_curve_picture(hn_strbuf *b, const hn_motion_curve *c, const char *title);
#endif
