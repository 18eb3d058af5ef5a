// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_SCENE_LIST_H
#define HN_TUI_SCENE_LIST_H
// The list of scenes, and the search in it: what is typed is looked for in name, title,
// description, kind and degrees of freedom of each scene; every word must be there.

#include "tui/workbench.h"

/// Opens the list of all scenes, the present one chosen.
void hn_scene_list_open(hn_workbench *w);
/// A key that belongs to the search: a character, Backspace, or Escape while something is typed.
/// false: it is for others.
bool hn_scene_list_key(hn_workbench *w, int key);
#endif
