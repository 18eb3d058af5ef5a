// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_PANELS_H
#define HN_TUI_PANELS_H
// The panels over the main view: lists to choose from, texts to read, and the line where something
// is typed.

#include "tui/keys.h"
#include "tui/workbench.h"

#include <stdarg.h>

/// Opens the panel or prompt of an action; actions without one do nothing.
void hn_panel_open(hn_workbench *w, hn_tui_action action);
void hn_panel_key(hn_workbench *w, int key);
/// Edits the line that is being typed; Enter acts on it, Escape forgets it.
void hn_prompt_key(hn_workbench *w, int key);

// what panels do to the workbench
/// Records the methods anew; on failure what was recorded stays.
HN_MUST_CHECK hn_status hn_workbench_record(hn_workbench *w, hn_diags *diags);
/// Opens a scene in place of the present one; on failure that one stays and the fault is said.
void hn_workbench_reopen(hn_workbench *w, const char *scene, const hn_setting *settings,
                         int n_settings, bool keep_methods);
void hn_workbench_say(hn_workbench *w, const char *format, ...) HN_PRINTF(2, 3);
void hn_workbench_say_fault(hn_workbench *w, const hn_diags *diags);
#endif
