// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_KEY_LINE_H
#define HN_TUI_KEY_LINE_H
// The line of keys below the workbench.

#include "tui/workbench.h"

/// The keys of what is shown, in so many columns. If they are too many, those before the last
/// are left out: the way to the menu or back is always there.
/// more: the card of incidents has more pages
void hn_key_line(const hn_workbench *w, bool more, int columns, char out[HN_TUI_LINE]);
#endif
