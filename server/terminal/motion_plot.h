// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_MOTION_PLOT_H
#define HN_TERMINAL_MOTION_PLOT_H
// Loop gap and energy change of one or several methods over time, as text: what --plot prints.

#include "terminal/plot.h"

typedef struct hn_motion_track {
    const char *name; ///< borrowed
    int slot;         ///< colour and glyph (render/look.h)
    double *gap, *energy;
} hn_motion_track;

typedef struct hn_motion_plot {
    double dt; ///< [s] between samples
    const char *gap_unit;
    int n_tracks, n, cap;
    hn_motion_track tracks[HN_PLOT_SERIES];
    bool failed; ///< memory ran out; the plot says so
} hn_motion_plot;

/// Room for the next sample of every track, NaN until it is set; false: no memory.
bool hn_motion_plot_next(hn_motion_plot *p);
void hn_motion_plot_free(hn_motion_plot *p);
/// Adds both plots and a legend, as wide as `columns`.
void hn_motion_plot_text(hn_strbuf *b, const hn_motion_plot *p, int columns, bool colours);
#endif
