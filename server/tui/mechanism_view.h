// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_MECHANISM_VIEW_H
#define HN_TUI_MECHANISM_VIEW_H
// The mechanism in dots: reference and ghosts dashed, the selected method full, open loops in the
// colour of alarm, a bar of known length.

#include "tui/workbench.h"

/// Draws the methods at the frame shown, or the mechanism that is dragged.
void hn_mechanism_view(hn_cells *c, hn_area area, const hn_workbench *w);
/// The scene of w->preview as it stands at its start.
void hn_mechanism_preview(hn_cells *c, hn_area area, const hn_workbench *w);

/// From the plane of the view to dots of an area: the envelope of the motion fills it.
typedef struct hn_placing {
    double scale, x, y; ///< dots a metre; dot of the view's origin
} hn_placing;
hn_placing hn_mechanism_place(const hn_envelope *envelope, hn_area area);
enum { HN_DOTS_ACROSS = 2, HN_DOTS_DOWN = 4 }; ///< of a cell
#endif
