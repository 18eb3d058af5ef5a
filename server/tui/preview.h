// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_PREVIEW_H
#define HN_TUI_PREVIEW_H
// A scene at its start, loaded for the list of scenes.

#include "tui/workbench.h"

/// Loads the scene into w->preview where another one is there; a scene that cannot be loaded, and
/// "", shows nothing.
void hn_preview_load(hn_workbench *w, const char *scene);
#endif
