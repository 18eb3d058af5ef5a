// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ENTRIES_H
#define HN_DYNAMICS_ENTRIES_H
// A sparse matrix of expressions as a list of entries that are not identically zero, in the order
// they were made.

#include "expr/graph.h"

typedef struct hn_entry {
    int row, col;
    hn_ex e;
} hn_entry;

typedef struct hn_entries {
    int n, cap, failed;
    hn_entry *at;
} hn_entries;

void hn_entries_add(hn_entries *list, int row, int col, hn_ex e); ///< a zero is not kept
/// Frees the entries; the list is then empty and can be used again.
void hn_entries_reset(hn_entries *list);
/// Sorts by row, then column.
void hn_entries_sort(hn_entries *list);
#endif
