// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_LIST_H
#define HN_TUI_LIST_H
// The items of the list that lies over the workbench.

#include "tui/workbench.h"

/// Opens an empty list.
void hn_list_begin(hn_workbench *w, hn_list_kind kind, const char *title);
/// Adds an item at the end and returns it; NULL: the list is full. about: may be NULL.
hn_item *hn_list_add(hn_workbench *w, const char *name, const char *about);
/// Returns how far a key moves in a list or a text; 0: it does not.
int hn_list_step(int key);
enum { HN_TUI_PAGE = 15 }; ///< lines of a page
#endif
