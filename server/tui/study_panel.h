// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_STUDY_PANEL_H
#define HN_TUI_STUDY_PANEL_H
// The panels of studies: what accuracy costs, and the map of stability over alpha and beta. They
// are drawn while they are computed.

#include "tui/workbench.h"

/// Starts a study of the scene and opens its panel.
void hn_study_panel_open(hn_workbench *w, hn_tui_study_kind kind);
/// Starts the study that is open again over another time of motion, as it was typed. false: it was
/// refused, and the fault is said.
bool hn_study_panel_set_time(hn_workbench *w, const char *text);
/// Escape stops a study that runs, and goes back from one that has ended; t asks for another time
/// of motion; arrows move the cursor of a map; Enter takes its alpha and beta.
void hn_study_panel_key(hn_workbench *w, int key);
void hn_study_panel_draw(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
