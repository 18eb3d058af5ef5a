// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_DOC_H
#define HN_SESSION_STABILITY_STABILITY_DOC_H
// See stability.h.

#include "session/stability/stability.h"

void hn_map_json(hn_strbuf *b, const hn_map *map);
void hn_map_csv(hn_strbuf *b, const hn_map *map); ///< one row a cell
#endif
