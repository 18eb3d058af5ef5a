// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/bars.h"

#include <math.h>

enum { INDENT = 2, LEAST_BAR = 8, MOST_BAR = 48 };

static int widest(const hn_bar *bars, int n, bool value) {
    int most = 0;
    for (int i = 0; i < n; i++) {
        const int columns = hn_text_columns(value ? bars[i].value : bars[i].label);
        most = columns > most ? columns : most;
    }
    return most;
}

static void draw_bar(hn_cells *c, hn_area area, int x, int y, int length, const hn_bar *bar) {
    const double share = fmin(1, fabs(bar->share));
    const int full = (int)lround(share * length);
    for (int i = 0; i < length && !isnan(bar->share); i++) {
        hn_cells_put(c, area, x + i, y, i < full ? bar->colour : HN_CELL_MUTED, 0,
                     i >= full        ? "░"
                     : bar->share < 0 ? "▒"
                                      : "█");
    }
}

void hn_bars_text(hn_strbuf *b, const hn_bar *bars, int n, int columns, bool colours) {
    hn_cells cells = {0};
    const int labels = widest(bars, n, false), values = widest(bars, n, true);
    const int room = columns - INDENT - labels - values - 4;
    const int length = room < LEAST_BAR ? LEAST_BAR : room > MOST_BAR ? MOST_BAR : room;
    if (n == 0 || !hn_cells_resize(&cells, columns, n)) {
        hn_strbuf_add(b, n == 0 ? "" : "no memory for the bars\n");
        return;
    }
    const hn_area page = {0, 0, columns, n};
    for (int i = 0; i < n; i++) {
        hn_cells_put(&cells, page, INDENT, i, HN_CELL_INK, 0, bars[i].label);
        draw_bar(&cells, page, INDENT + labels + 2, i, length, &bars[i]);
        hn_cells_put(&cells, page, INDENT + labels + length + 4, i, HN_CELL_INK, 0, bars[i].value);
    }
    hn_cells_text(b, &cells, colours);
    hn_cells_free(&cells);
}
