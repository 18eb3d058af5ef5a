// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/table.h"

#include "base/units.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void hn_table_init(hn_table *t) {
    *t = (hn_table){0};
}

void hn_table_reset(hn_table *t) {
    free(t->cells);
    hn_table_init(t);
}

void hn_table_column(hn_table *t, const char *head, int to_right) {
    HN_ASSERT(t->n_columns < HN_TABLE_COLUMNS && t->n_cells == 0);
    t->heads[t->n_columns] = head;
    t->to_right[t->n_columns] = to_right;
    t->n_columns++;
}

/// An ellipsis at the end of what did not fit, between two characters.
static void mark_cut(char cell[HN_TABLE_CELL]) {
    static const char ELLIPSIS[] = "\xe2\x80\xa6";
    size_t n = HN_TABLE_CELL - sizeof ELLIPSIS;
    while (n > 0 && ((unsigned char)cell[n] & 0xc0) == 0x80) {
        n--;
    }
    memcpy(cell + n, ELLIPSIS, sizeof ELLIPSIS);
}

void hn_table_cell(hn_table *t, const char *format, ...) {
    if (t->n_cells == t->cap) {
        int cap = t->cap ? 2 * t->cap : 64;
        char(*larger)[HN_TABLE_CELL] = realloc(t->cells, (size_t)cap * sizeof *larger);
        if (!larger) {
            t->failed = 1;
            return;
        }
        t->cells = larger;
        t->cap = cap;
    }
    va_list args;
    va_start(args, format);
    if (vsnprintf(t->cells[t->n_cells], HN_TABLE_CELL, format, args) >= HN_TABLE_CELL) {
        mark_cut(t->cells[t->n_cells]);
    }
    va_end(args);
    t->n_cells++;
}

void hn_table_quantity(hn_table *t, double value, const char *unit) {
    char text[HN_SI_TEXT];
    if (!isfinite(value)) {
        hn_table_cell(t, "-");
        return;
    }
    hn_si_format(value, unit, 3, text);
    hn_table_cell(t, "%s", text);
}

/// Columns on a terminal: characters, not bytes.
static int width_of(const char *text) {
    int width = 0;
    for (; *text; text++) {
        width += (*text & 0xc0) != 0x80;
    }
    return width;
}

static void write_cell(hn_strbuf *b, const char *text, int width, int to_right, int last) {
    int pad = width - width_of(text);
    if (to_right) {
        hn_strbuf_printf(b, "%*s%s", pad, "", text);
    } else {
        hn_strbuf_printf(b, "%s%*s", text, last ? 0 : pad, "");
    }
    hn_strbuf_add(b, last ? "\n" : "  ");
}

void hn_table_write(hn_strbuf *b, const hn_table *t) {
    int widths[HN_TABLE_COLUMNS] = {0};
    for (int c = 0; c < t->n_columns; c++) {
        widths[c] = width_of(t->heads[c]);
        for (int i = c; i < t->n_cells; i += t->n_columns) {
            int width = width_of(t->cells[i]);
            widths[c] = width > widths[c] ? width : widths[c];
        }
        write_cell(b, t->heads[c], widths[c], t->to_right[c], c == t->n_columns - 1);
    }
    for (int i = 0; i < t->n_cells; i++) {
        int c = i % t->n_columns;
        write_cell(b, t->cells[i], widths[c], t->to_right[c], c == t->n_columns - 1);
    }
    b->failed |= t->failed;
}
