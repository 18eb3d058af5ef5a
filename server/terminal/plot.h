// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_PLOT_H
#define HN_TERMINAL_PLOT_H
// A plot over time in character cells: axes with a few labelled ticks, one line a method.

#include "terminal/dots.h"

enum { HN_PLOT_SERIES = 9, HN_PLOT_LABEL = 12 };

typedef struct hn_series {
    const double *y; ///< values at k * dt; NaN: a hole
    int n;
    int colour;        ///< of the line (hn_look slot)
    const char *glyph; ///< marks the end of the line
    int on, off;       ///< dashes, in dots; off 0: a full line
} hn_series;

typedef struct hn_plot {
    double dt, t_end; ///< [s] between values; end of the axis
    double cursor;    ///< [s]; NaN: none
    bool logarithmic; ///< values are shown by their size; 0 stands at the floor
    double floor;     ///< least value shown on a logarithmic axis, above 0
    const char *unit; ///< of y; a logarithmic axis shows powers of ten of it
    double low, high; ///< ends of the axis of y; both 0: fitted to the values
    int intervals;    ///< of the axis of time, with a label between each two; 0: ends alone
    int n;
    hn_series series[HN_PLOT_SERIES];
} hn_plot;

/// Draws into the area: labels to the left, time below, lines between. An area too small for axes
/// stays blank. Allocates its dots; without memory the lines are left out.
void hn_plot_draw(hn_cells *c, hn_area area, const hn_plot *plot, hn_dot_form form);
#endif
