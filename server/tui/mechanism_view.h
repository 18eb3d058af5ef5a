// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_MECHANISM_VIEW_H
#define HN_TUI_MECHANISM_VIEW_H
// The mechanism in dots: one configuration a method, the selected one on top, the reference in grey
// beneath.

#include "tui/workbench.h"

/// Draws the mechanism of every method into this area.
void hn_mechanism_view(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
