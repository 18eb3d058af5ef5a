// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_STORE_H
#define HN_SESSION_STABILITY_STABILITY_STORE_H
// The journal of an unfinished map: a line for each cell, for each observed boundary and for
// the largest accurate step of each method.

#include "session/stability/stability_internal.h"

/// Opens the journal of this map and reads what it holds into the map. Fails as hn_journal_open().
HN_MUST_CHECK hn_status hn_map_open_journal(hn_map *map, hn_diags *diags);
void hn_map_keep_cell(hn_map *map, int m, int column, int row);
void hn_map_keep_column(hn_map *map, int m, int column);
void hn_map_keep_accuracy(hn_map *map, int m);
#endif
