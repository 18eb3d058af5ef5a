// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_TEXT_PANEL_H
#define HN_TUI_TEXT_PANEL_H
// The panel of a text: what it shows, and commands whose text it shows as it comes.

#include "tui/workbench.h"

/// An empty text with this title; a command that was shown ends.
void hn_text_panel_open(hn_workbench *w, const char *title);
/// Scrolls no further than is needed to show the lines from first to before last; the first of them
/// where not all have room.
void hn_text_panel_reveal(hn_workbench *w, int first, int last);
/// Keys of a text: lines, pages, its ends.
void hn_text_panel_key(hn_workbench *w, int key);
/// Shows the text from this line on, but never less than its last page.
void hn_text_panel_scroll(hn_workbench *w, int line);
enum { HN_TUI_WORDS = 16 };
enum { HN_TUI_PARAGRAPH = 8192 }; ///< bytes of a line, which is a paragraph, that are shown
/// Runs `holonom` with these words, and with the settings of the scene, and shows its text.
void hn_text_panel_run(hn_workbench *w, const char *title, const char *const *words, int n);
#endif
