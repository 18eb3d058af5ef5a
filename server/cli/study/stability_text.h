// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_STABILITY_TEXT_H
#define HN_CLI_STABILITY_TEXT_H
// A map of stability for a terminal.

#include "session/stability/stability.h"

/// Writes a map of characters for each method, with the predicted boundary in it and the agreement
/// below; a map with one column is a table of limits.
void hn_map_text(hn_strbuf *b, const hn_map *map);
/// The maps alone.
void hn_map_plots_text(hn_strbuf *b, const hn_map *map);
#endif
