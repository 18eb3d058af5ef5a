// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_COST_PLOT_H
#define HN_TERMINAL_COST_PLOT_H
// Error against cost in character cells: the plot of a work-precision study, finished or not.

#include "session/precision/study.h"
#include "terminal/scatter.h"

/// The points of a study as they are now; a copy that outlives it.
typedef struct hn_cost_plot {
    hn_scatter scatter;
    bool by_time; ///< the cost is CPU time; otherwise operations
    char name[HN_WP_METHODS][HN_SPEC_MAX];
    int done[HN_WP_METHODS], failed[HN_WP_METHODS], levels;
} hn_cost_plot;

/// Returns whether CPU time was measured.
bool hn_cost_plot_has_times(const hn_wp *wp);
/// Copies what is done so far, over CPU time or over operations.
void hn_cost_plot_take(hn_cost_plot *p, const hn_wp *wp, bool by_time);
/// "error of the coordinates over CPU time (log, error without unit; ╳: ended)"
const char *hn_cost_plot_title(const hn_cost_plot *p);
/// Draws the points. Returns false, and draws nothing, while they span no range.
bool hn_cost_plot_draw(hn_cells *c, hn_area area, const hn_cost_plot *p, hn_dot_form form);
/// Adds title, plot and, with `legend`, a line a method, as wide as `columns`; nothing where the
/// points span no range.
void hn_cost_plot_text(hn_strbuf *b, const hn_cost_plot *p, int columns, bool legend, bool colours);
#endif
