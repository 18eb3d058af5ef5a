// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_PANELS_H
#define HN_TUI_PANELS_H
// The panels over the main view: lists to choose from and texts to read.

#include "terminal/keys.h"
#include "tui/workbench.h"

/// Opens the panel or prompt of an action; actions without one do nothing.
void hn_panel_open(hn_workbench *w, hn_tui_action action);
void hn_panel_key(hn_workbench *w, int key);
#endif
