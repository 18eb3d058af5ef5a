// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_DRAG_H
#define HN_TUI_DRAG_H
// The mechanism dragged by the mouse: a joint follows it as far as the loops allow, and where it is
// let go becomes the start of all methods.

#include "tui/workbench.h"

/// Takes hold of the drawn point nearest to a cell of the mechanism's area; nothing where none is
/// near. Time stops.
void hn_drag_begin(hn_workbench *w, hn_area area, int x, int y);
/// The held point follows to the cell.
void hn_drag_move(hn_workbench *w, hn_area area, int x, int y);
/// Lets go: the methods start from here.
void hn_drag_end(hn_workbench *w);
#endif
