// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_VIEW_BOX_H
#define HN_TUI_VIEW_BOX_H
// The region that the view of the mechanism shows: the envelope of its motion, widened by what the
// recorded methods do beyond it, for instance where a parallelogram leaves its own branch.

#include "tui/workbench.h"

/// Begins a new recording: the view shows the envelope of the motion again.
void hn_view_box_begin(hn_workbench *w);
/// Widens the view by the frames recorded since the last call. A method that flies away is followed
/// for half of the mechanism's size on each side, as a view of its whole path would show a dot.
void hn_view_box_update(hn_workbench *w);
void hn_view_box_free(hn_workbench *w);
#endif
