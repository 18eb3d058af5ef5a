// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_REMEDIES_H
#define HN_TUI_REMEDIES_H
// The remedies of the selected method's incidents as a list: one of them is tried with Enter.

#include "tui/workbench.h"

/// Opens the list; says so where the method has no remedies.
void hn_remedies_open(hn_workbench *w);
/// Tries the chosen one: "h=0.005" changes the selected method, a spelling joins the methods and is
/// selected, other words are said again.
void hn_remedies_take(hn_workbench *w);
#endif
