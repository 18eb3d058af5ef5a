// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_PROMPT_H
#define HN_TUI_PROMPT_H
// The line where something is typed: a step, a method, a value, the name of a file.

#include "tui/workbench.h"

/// The first of the exports: the recording as CSV; the others are languages.
#define HN_TUI_RECORDING "recording"

/// Asks for the file that the chosen item of the list of exports goes to.
void hn_prompt_export(hn_workbench *w);
/// A key while a line is typed: Escape forgets it, Enter hands it over; a line
/// that is refused stays open, as it was typed. The first letter replaces
/// what was filled in; after an arrow or Backspace letters are added to it.
void hn_prompt_key(hn_workbench *w, int key);
/// Another value of a parameter or start; everything starts again. Returns whether it was
/// taken; else the fault is said.
bool hn_prompt_set_parameter(hn_workbench *w, const char *name, double value);
#endif
