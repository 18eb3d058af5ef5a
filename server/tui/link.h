// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_LINK_H
#define HN_TUI_LINK_H
// Links of the page: the part after # holds scene, parameters, methods and frame
// (web/state/link.js).

#include "tui/workbench.h"

/// The address of the page's link to what is shown: "http://127.0.0.1:8080/#scene=...".
void hn_workbench_link(const hn_workbench *w, hn_strbuf *b);
/// Where the scene and its methods come from in a link of the page (the part after #, or the whole
/// address); false: no link.
bool hn_workbench_read_link(const char *link, char scene[HN_TUI_LINE], hn_setting *settings,
                            char (*names)[64], int *n_settings, char (*methods)[HN_SPEC_MAX],
                            int *n_methods);
#endif
