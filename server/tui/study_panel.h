// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_STUDY_PANEL_H
#define HN_TUI_STUDY_PANEL_H
// The panels of studies: what accuracy costs, and the map of stability over alpha and beta. They
// are drawn while they are computed.

#include "tui/workbench.h"

/// Starts a study of the scene and opens its panel.
void hn_study_panel_open(hn_workbench *w, hn_tui_study_kind kind);
/// Stops the study of the panel and goes back to the motion.
void hn_study_panel_close(hn_workbench *w);
/// When a short study of the cost has ended, for which nobody typed a time of motion: measures the
/// whole motion behind it, and shows that in its place when it has ended too. To be called again
/// and again.
void hn_study_panel_follow(hn_workbench *w);
/// Returns whether a study is computed, or is about to be.
bool hn_study_panel_is_busy(const hn_workbench *w);
/// Starts the study that is open again over another time of motion, as it was typed. false: it was
/// refused, and the fault is said.
bool hn_study_panel_set_time(hn_workbench *w, const char *text);
/// Escape stops a study that runs, and goes back from one that has ended; t asks for another time
/// of motion; arrows move the cursor of a map; Enter takes its alpha and beta.
void hn_study_panel_key(hn_workbench *w, int key);
void hn_study_panel_draw(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
