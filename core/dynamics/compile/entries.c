// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/entries.h"

#include <stdlib.h>

void hn_entries_add(hn_entries *list, int row, int col, hn_ex e) {
    if (hn_is_zero(e) || list->failed) {
        return;
    }
    if (list->n == list->cap) {
        int cap = list->cap ? 2 * list->cap : 64;
        hn_entry *grown = realloc(list->at, (size_t)cap * sizeof *grown);
        if (!grown) {
            list->failed = 1;
            return;
        }
        list->at = grown;
        list->cap = cap;
    }
    list->at[list->n++] = (hn_entry){row, col, e};
}

void hn_entries_reset(hn_entries *list) {
    free(list->at);
    *list = (hn_entries){0};
}

static int compare(const void *a, const void *b) {
    const hn_entry *x = a, *y = b;
    if (x->row != y->row) {
        return x->row < y->row ? -1 : 1;
    }
    return x->col < y->col ? -1 : x->col > y->col;
}

void hn_entries_sort(hn_entries *list) {
    if (list->n > 1) {
        qsort(list->at, (size_t)list->n, sizeof *list->at, compare);
    }
}
