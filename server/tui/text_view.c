// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/text_view.h"

#include "cli/shell/plain.h"
#include "tui/text_panel.h"

#include <stdio.h>
#include <string.h>

void hn_text_view_paragraph(const hn_workbench *w, const char *line, size_t n,
                            char out[HN_TUI_PARAGRAPH]) {
    snprintf(out, HN_TUI_PARAGRAPH, "%.*s", (int)(n < HN_TUI_PARAGRAPH ? n : HN_TUI_PARAGRAPH - 1),
             line);
    if (w->form == HN_DOTS_ASCII) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_text(&plain, out);
        snprintf(out, HN_TUI_PARAGRAPH, "%s", hn_strbuf_text(&plain));
        hn_strbuf_reset(&plain);
    }
}

int hn_text_view_indent(const char *paragraph, int columns) {
    const int indent = (int)strspn(paragraph, " ");
    return indent < columns / 2 ? indent : 0;
}

/// Says in the lower edge of the panel that there is more above or below.
static void draw_rest(hn_cells *c, hn_area area, bool above, bool below) {
    const char *words = above && below ? " ↑↓ more " : above ? " ↑ more " : below ? " ↓ more " : "";
    const int x = area.columns - 2 - hn_text_columns(words);
    hn_cells_put(c, area, x, area.rows - 1, HN_CELL_MUTED, 0, words);
}

void hn_text_view_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    const hn_area in = hn_cells_frame(c, area, w->title);
    const char *text = hn_strbuf_text(&w->text), *at = text;
    int line = 0, y = 0;
    for (; *at && y < in.rows; line++) {
        const size_t n = strcspn(at, "\n");
        char row[HN_TUI_PARAGRAPH];
        hn_text_view_paragraph(w, at, n, row);
        if (line >= w->scroll) {
            const int indent = hn_text_view_indent(row, in.columns - 2);
            const hn_area rest = {in.x + 1 + indent, in.y + y, in.columns - 2 - indent,
                                  in.rows - y};
            const int used = hn_cells_fold(c, rest, 0, HN_CELL_INK, row + indent);
            if (line == w->marked) {
                hn_cells_mark(c, (hn_area){rest.x, rest.y, rest.columns, used});
            }
            y += used > 0 ? used : 1;
        }
        at += n + (at[n] == '\n');
    }
    draw_rest(c, area, w->scroll > 0, *at != '\0');
}
