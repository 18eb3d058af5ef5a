// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_MECHANISM_VIEW_H
#define HN_TUI_MECHANISM_VIEW_H
// The mechanism in dots: reference and ghosts dashed, the selected method full, open loops in the
// colour of alarm, a bar of known length.

#include "tui/workbench.h"

/// Draws the methods at the frame shown, or the mechanism that is dragged; nothing where a picture
/// is shown (mechanism_picture.h).
void hn_mechanism_view(hn_cells *c, hn_area area, const hn_workbench *w);
/// The scene of w->preview as it stands at its start; likewise.
void hn_mechanism_preview(hn_cells *c, hn_area area, const hn_workbench *w);

/// Returns the place of the mechanism in an area: that of the picture, or the one where the
/// envelope of the motion fills the area.
hn_placing hn_mechanism_place(const hn_workbench *w, hn_area area);
enum { HN_DOTS_ACROSS = 2, HN_DOTS_DOWN = 4 }; ///< of a cell
#endif
