// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_LINK_H
#define HN_TUI_LINK_H
// Links of the page: the part after # holds scene, parameters, methods and frame
// (web/state/link.js).

#include "tui/workbench.h"

/// The address of the page's link to what is shown: "http://127.0.0.1:8080/#scene=...".
void hn_workbench_link(const hn_workbench *w, hn_strbuf *b);

/// The content of a link of the page.
typedef struct hn_tui_link {
    char scene[HN_TUI_LINE];
    hn_setting settings[HN_TUI_SETTINGS]; ///< their names are those in `names`
    char names[HN_TUI_SETTINGS][64];
    char methods[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    int n_settings, n_methods;
    int frame;                   ///< of the page; -1: none, it is at the start
    int selected;                ///< method
    double speed;                ///< times real time
    hn_tui_plot plot;            ///< the page's upper one, where it is drawn here too
    char faults[HN_TUI_MESSAGE]; ///< what could not be read; "": nothing
} hn_tui_link;

/// Reads a link of the page (the part after #, or the whole address). False: it is no link; scene
/// and numbers are then empty and frame is -1.
bool hn_workbench_read_link(const char *text, hn_tui_link *link);
/// Takes frame, selected method, speed and plot of a link that was opened.
void hn_workbench_go_to_link(hn_workbench *w, const hn_tui_link *link);
#endif
