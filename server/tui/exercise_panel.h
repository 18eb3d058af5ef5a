// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_EXERCISE_PANEL_H
#define HN_TUI_EXERCISE_PANEL_H
// The panel in which an exercise is answered: a text with a field for each part.

#include "tui/workbench.h"

/// Opens an exercise by its id; the one that was open last has its answers still.
void hn_exercise_panel_open(hn_workbench *w, const char *id);
void hn_exercise_panel_key(hn_workbench *w, int key);
/// Takes the line that was typed as the answer of the chosen field.
void hn_exercise_panel_accept(hn_workbench *w);
#endif
