// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_HTML_H
#define HN_SESSION_STABILITY_STABILITY_HTML_H
// A map as SVG, on its own and inside one HTML file: no network, no script. A cell's outcome is its
// title, which a browser shows when the cell is pointed at.

#include "session/stability/stability.h"

void hn_map_svg(hn_strbuf *b, const hn_map *map); ///< light theme, all methods one below the other
void hn_map_html(
    hn_strbuf *b,
    const hn_map *map); ///< one file without network; a cell tells its outcome when pointed at
#endif
