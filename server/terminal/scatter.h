// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_SCATTER_H
#define HN_TERMINAL_SCATTER_H
// A plot of points over two logarithmic axes in character cells: a glyph for every point, a line
// through the points of a series.

#include "terminal/dots.h"

enum { HN_SCATTER_SERIES = 24, HN_SCATTER_POINTS = 12 };

typedef struct hn_scatter_point {
    double x, y;  ///< above 0
    bool on_edge; ///< it has no y: it is marked on the upper edge, at its x
} hn_scatter_point;

typedef struct hn_scatter_series {
    int n, colour; ///< colour: slot of render/look.h
    const char *glyph;
    hn_scatter_point point[HN_SCATTER_POINTS];
} hn_scatter_series;

typedef struct hn_scatter {
    const char *x_unit, *x_name; ///< static texts; x_name NULL: none
    double y_high;               ///< upper end of the vertical axis
    int n;
    hn_scatter_series series[HN_SCATTER_SERIES];
} hn_scatter;

/// Draws into the area: decades to the left, the ends of the horizontal axis and its name below.
/// Points without a range, or an area too small for axes, leave it blank; the return value says
/// whether something was drawn.
bool hn_scatter_draw(hn_cells *c, hn_area area, const hn_scatter *s, hn_dot_form form);
#endif
