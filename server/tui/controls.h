// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_CONTROLS_H
#define HN_TUI_CONTROLS_H
// What keys do: to the clock and the selection here, to panels and the typed line in panels.h.

#include "tui/workbench.h"

/// Obeys a key of hn_tui_keys(), a character, or one of HN_KEY_*.
void hn_controls_key(hn_workbench *w, int key);
#endif
