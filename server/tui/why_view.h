// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_WHY_VIEW_H
#define HN_TUI_WHY_VIEW_H
// The card that says why: the rule of the selected method, its incidents, and the remedies of each,
// apart those that a trial confirmed and those that nobody has tried.

#include "tui/workbench.h"

enum { HN_WHY_WORDS = 480 };

/// Returns whether an incident of the selected method has a remedy.
bool hn_why_has_remedy(const hn_workbench *w);
/// Returns whether the card of the selected method is longer than this area.
bool hn_why_has_more(hn_area area, const hn_workbench *w);
/// Goes to the next page of the card in this area (by > 0), or to the one before.
void hn_why_scroll(hn_workbench *w, hn_area area, int by);
/// Starts the card at its top where another method is selected than before.
void hn_why_follow(hn_workbench *w);
void hn_why_draw(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
