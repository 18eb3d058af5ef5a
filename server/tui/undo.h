// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_UNDO_H
#define HN_TUI_UNDO_H
// Undo and redo of changes of scene, settings and methods.

#include "tui/workbench.h"

/// Opens the version before (by -1) or after (by 1) the present one; says so where there is none.
void hn_undo_go(hn_workbench *w, int by);
#endif
