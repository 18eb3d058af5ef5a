// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_VIEWS_H
#define HN_TUI_VIEWS_H
// One frame of the workbench, drawn into cells: header, mechanism, plot, method table, notice,
// keys.
//
//    holonom  four-bar  t 3.42 s of 10 s  x1  running
//   +- mechanism -----------+- loop gap [m] -----------------+
//   |                       |                                |
//   +- methods -------------+--------------------------------+
//   | 1 * index-1    gap 3.2 mm  energy 0.28 J  open by ...  |
//    ! what happened last                          keys

#include "tui/workbench.h"

/// Least size of a screen that shows everything; smaller ones show what fits. The second pair is
/// the least size of a panel; the main view needs more, by its methods, and says how much.
enum { HN_TUI_COLUMNS = 80, HN_TUI_ROWS = 24, HN_TUI_LEAST_COLUMNS = 20, HN_TUI_LEAST_ROWS = 8 };

/// Chooses the incident that is told, which takes its rows from the views; before each drawing.
void hn_views_update(hn_workbench *w);
/// The least size of a screen for what is open.
void hn_views_least_size(const hn_workbench *w, int *columns, int *rows);
/// Returns whether a screen of this size is smaller: it then says the least size alone.
bool hn_views_too_small(const hn_workbench *w, int columns, int rows);
/// Draws the whole screen.
void hn_views_draw(hn_cells *c, const hn_workbench *w);
/// The places where the last frame of this size has its table and plot, for the mouse.
typedef struct hn_places {
    hn_area table, plot;
} hn_places;
hn_places hn_views_places(int columns, int rows, const hn_workbench *w);
/// The area of the mechanism in the last frame of this size: on the main view, and to the right of
/// the list of scenes. false: there is none.
bool hn_views_mechanism(int columns, int rows, const hn_workbench *w, hn_area *out);
#endif
