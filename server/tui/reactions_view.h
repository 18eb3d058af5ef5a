// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_REACTIONS_VIEW_H
#define HN_TUI_REACTIONS_VIEW_H
// Multipliers and joint forces of the selected method at the frame shown, in place of the plot.
//
//   projection at t = 1 s: multipliers determined
//     B: x          16.4
//   force [N] on            size        x        y
//     A on coupler          29.9    -28.7    -8.51
//
// They are computed from the method's state at this frame as `holonom run --reactions` does, with
// the same signs (dynamics/reactions/reactions.h).

#include "tui/workbench.h"

/// Opens the view in place of the plot, or closes it; hn_workbench_tick() makes w->forces.
void hn_reactions_toggle(hn_workbench *w);
/// Moves the lines by half a page, down (1) or up (-1).
void hn_reactions_scroll(hn_workbench *w, int by);
/// Computes the forces of the selected method at the frame shown, into w->forces; nothing while the
/// view is closed.
void hn_reactions_update(const hn_workbench *w);
/// Draws the view with the numbers of hn_reactions_update().
void hn_reactions_draw(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
