// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_CONTROLS_H
#define HN_TUI_CONTROLS_H
// Carries out the keys of the clock and of the selection; panels.h has those of panels and of the
// typed line.

#include "tui/workbench.h"

/// Obeys a key of hn_tui_keys(), a character, or one of HN_KEY_*.
void hn_controls_key(hn_workbench *w, int key);
#endif
