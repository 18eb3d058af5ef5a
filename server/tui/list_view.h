// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_LIST_VIEW_H
#define HN_TUI_LIST_VIEW_H
// A list as it is drawn: its rows, below them what the chosen one is about, and beside the list of
// scenes a picture of the chosen one.

#include "terminal/cells.h"
#include "tui/workbench.h"

/// Draws the list that is open into `area`, as far as its rows fit.
void hn_list_view_draw(hn_cells *c, hn_area area, const hn_workbench *w);
/// The place of the picture inside the panel `in`; false: this list has none, or no room for it.
bool hn_list_view_picture(hn_area in, const hn_workbench *w, hn_area *out);
#endif
