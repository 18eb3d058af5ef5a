// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/list.h"

#include "terminal/keys.h"

#include <math.h>
#include <stdio.h>

void hn_list_begin(hn_workbench *w, hn_list_kind kind, const char *title) {
    w->panel = HN_PANEL_LIST;
    w->list = kind;
    w->n_items = w->cursor = w->scroll = 0;
    w->over_study = false;
    w->n_search = kind == HN_LIST_SCENES ? w->n_search : 0;
    snprintf(w->title, sizeof w->title, "%s", title);
}

hn_item *hn_list_add(hn_workbench *w, const char *name, const char *about) {
    if (w->n_items == HN_TUI_ITEMS) {
        return NULL;
    }
    hn_item *item = &w->items[w->n_items++];
    *item = (hn_item){.value = (double)NAN};
    snprintf(item->name, sizeof item->name, "%s", name);
    snprintf(item->about, sizeof item->about, "%s", about ? about : "");
    return item;
}

int hn_list_step(int key) {
    switch (key) {
    case HN_KEY_UP:
        return -1;
    case HN_KEY_DOWN:
        return 1;
    case HN_KEY_PAGE_UP:
        return -HN_TUI_PAGE;
    case HN_KEY_PAGE_DOWN:
        return HN_TUI_PAGE;
    case HN_KEY_HOME:
        return -1000000;
    case HN_KEY_END:
        return 1000000;
    default:
        return 0;
    }
}
