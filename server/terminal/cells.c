// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/cells.h"

#include "render/look.h"
#include "terminal/line_break.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 1000, MOST_ROWS = 500, LINE = 1024 };

bool hn_cells_resize(hn_cells *c, int columns, int rows) {
    columns = columns < 1 ? 1 : columns > MOST_COLUMNS ? MOST_COLUMNS : columns;
    rows = rows < 1 ? 1 : rows > MOST_ROWS ? MOST_ROWS : rows;
    hn_cell *at = calloc((size_t)columns * (size_t)rows, sizeof *at);
    hn_cells_free(c);
    if (!at) {
        return false;
    }
    *c = (hn_cells){columns, rows, at};
    hn_cells_clear(c);
    return true;
}

void hn_cells_free(hn_cells *c) {
    free(c->at);
    *c = (hn_cells){0};
}

void hn_cells_clear(hn_cells *c) {
    memset(c->at, 0, (size_t)c->columns * (size_t)c->rows * sizeof *c->at);
    for (int i = 0; i < c->columns * c->rows; i++) {
        c->at[i].colour = HN_CELL_INK;
    }
}

// ---- characters ----

/// Bytes of the character at text: 1 to 4; 0 at the end. Bytes that are no UTF-8 count as one
/// character each.
static int character_bytes(const char *text) {
    const unsigned char first = (unsigned char)text[0];
    const int n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : first != 0;
    for (int i = 1; i < n; i++) {
        if (((unsigned char)text[i] & 0xc0) != 0x80) {
            return 1;
        }
    }
    return n;
}

static unsigned code_of(const char *text, int n) {
    const unsigned char *b = (const unsigned char *)text;
    switch (n) {
    case 2:
        return (b[0] & 0x1fu) << 6 | (b[1] & 0x3fu);
    case 3:
        return (b[0] & 0x0fu) << 12 | (b[1] & 0x3fu) << 6 | (b[2] & 0x3fu);
    case 4:
        return (b[0] & 0x07u) << 18 | (b[1] & 0x3fu) << 12 | (b[2] & 0x3fu) << 6 | (b[3] & 0x3fu);
    default:
        return b[0];
    }
}

/// Combining marks take no column; the program's own texts hold nothing that takes two.
static bool combines(unsigned code) {
    return (code >= 0x0300 && code <= 0x036f) || code == 0x200b || code == 0xfe0f;
}

int hn_text_columns(const char *text) {
    int columns = 0;
    for (int n; (n = character_bytes(text)) > 0; text += n) {
        columns += !combines(code_of(text, n));
    }
    return columns;
}

// ---- writing ----

static hn_cell *cell_at(hn_cells *c, hn_area area, int x, int y) {
    const int column = area.x + x, row = area.y + y;
    const bool inside = x >= 0 && y >= 0 && x < area.columns && y < area.rows && column >= 0 &&
                        row >= 0 && column < c->columns && row < c->rows;
    return inside ? &c->at[row * c->columns + column] : NULL;
}

static void set_glyph(hn_cell *cell, const char *text, int n) {
    const bool control =
        n == 1 && ((unsigned char)text[0] < 0x20 || (unsigned char)text[0] >= 0x7f);
    memset(cell->glyph, 0, sizeof cell->glyph);
    if (control) {
        cell->glyph[0] = ' ';
    } else {
        memcpy(cell->glyph, text, (size_t)n);
    }
}

static void join_glyph(hn_cell *cell, const char *text, int n) {
    const size_t had = strlen(cell->glyph);
    if (had > 0 && had + (size_t)n < sizeof cell->glyph) {
        memcpy(cell->glyph + had, text, (size_t)n);
    }
}

int hn_cells_put(hn_cells *c, hn_area area, int x, int y, int colour, int style, const char *text) {
    const int first = x;
    for (int n; (n = character_bytes(text)) > 0; text += n) {
        if (combines(code_of(text, n))) {
            hn_cell *before = cell_at(c, area, x - 1, y);
            if (before) {
                join_glyph(before, text, n);
            }
            continue;
        }
        hn_cell *cell = cell_at(c, area, x++, y);
        if (cell) {
            set_glyph(cell, text, n);
            cell->colour = (unsigned char)colour;
            cell->style = (unsigned char)style;
        }
    }
    return x - first;
}

int hn_cells_printf(hn_cells *c, hn_area area, int x, int y, int colour, int style,
                    const char *format, ...) {
    char line[LINE];
    va_list list;
    va_start(list, format);
    vsnprintf(line, sizeof line, format, list);
    va_end(list);
    return hn_cells_put(c, area, x, y, colour, style, line);
}

/// Bytes of the longest beginning of text that fits, broken at a blank where there is one, best
/// at one where a line may end.
static size_t fitting(const char *text, int columns) {
    size_t bytes = 0, blank = 0, other = 0;
    int used = 0;
    for (int n; (n = character_bytes(text + bytes)) > 0; bytes += (size_t)n) {
        if (text[bytes] == '\n') {
            return bytes;
        }
        if (text[bytes] == ' ') {
            other = bytes;
            blank = hn_line_may_break(text, bytes) ? bytes : blank;
        }
        if (++used > columns) {
            return blank > 0 ? blank : other > 0 ? other : bytes;
        }
    }
    return bytes;
}

int hn_cells_fold(hn_cells *c, hn_area area, int y, int colour, const char *text) {
    while (*text && y < area.rows && area.columns > 0) {
        const size_t n = fitting(text, area.columns);
        char line[LINE];
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        hn_cells_put(c, area, 0, y++, colour, HN_CELL_PLAIN, line);
        text += n;
        text += *text == ' ' || *text == '\n';
    }
    return y;
}

int hn_text_rows(const char *text, int columns) {
    int rows = 0;
    while (*text && columns > 0) {
        text += fitting(text, columns);
        text += *text == ' ' || *text == '\n';
        rows++;
    }
    return rows;
}

void hn_cells_put_fitted(hn_cells *c, hn_area area, int x, int y, int colour, int style,
                         const char *text) {
    static const char ellipsis[] = " …";
    const int room = area.columns - x;
    if (room <= 0 || hn_text_columns(text) <= room) {
        hn_cells_put(c, area, x, y, colour, style, text);
        return;
    }

    // whole words, while they leave no more than half of the room empty
    char line[LINE];
    const size_t n = fitting(text, room > 2 ? room - 2 : 1);
    snprintf(line, sizeof line, "%.*s%s", (int)n, text, ellipsis);
    if (text[n] == ' ' && 2 * hn_text_columns(line) > room) {
        hn_cells_put(c, area, x, y, colour, style, line);
    } else {
        hn_cells_put(c, area, x, y, colour, style, text);
        hn_cells_put(c, area, area.columns - 1, y, colour, style, "…");
    }
}

void hn_cells_fold_fitted(hn_cells *c, hn_area area, int colour, const char *text) {
    hn_cells_fold(c, area, 0, colour, text);
    if (hn_text_rows(text, area.columns) > area.rows) {
        int x = area.columns - 1;
        const hn_cell *row = &c->at[(area.y + area.rows - 1) * c->columns + area.x];
        while (x > 0 && (row[x - 1].glyph[0] == '\0' || row[x - 1].glyph[0] == ' ')) {
            x--;
        }
        hn_cells_put(c, area, x, area.rows - 1, colour, 0, "…");
    }
}

void hn_cells_mark(hn_cells *c, hn_area area) {
    for (int y = 0; y < area.rows; y++) {
        for (int x = 0; x < area.columns; x++) {
            hn_cell *cell = cell_at(c, area, x, y);
            if (cell) {
                cell->style |= HN_CELL_REVERSE;
            }
        }
    }
}

hn_area hn_cells_frame(hn_cells *c, hn_area area, const char *title) {
    const int right = area.columns - 1, bottom = area.rows - 1;
    for (int x = 1; x < right; x++) {
        hn_cells_put(c, area, x, 0, HN_CELL_MUTED, 0, "─");
        hn_cells_put(c, area, x, bottom, HN_CELL_MUTED, 0, "─");
    }
    for (int y = 1; y < bottom; y++) {
        hn_cells_put(c, area, 0, y, HN_CELL_MUTED, 0, "│");
        hn_cells_put(c, area, right, y, HN_CELL_MUTED, 0, "│");
    }
    hn_cells_put(c, area, 0, 0, HN_CELL_MUTED, 0, "┌");
    hn_cells_put(c, area, right, 0, HN_CELL_MUTED, 0, "┐");
    hn_cells_put(c, area, 0, bottom, HN_CELL_MUTED, 0, "└");
    hn_cells_put(c, area, right, bottom, HN_CELL_MUTED, 0, "┘");
    const hn_area edge = {area.x + 2, area.y, area.columns - 4, 1};
    hn_cells_printf(c, edge, 0, 0, HN_CELL_INK, 0, " %s ", title);
    return (hn_area){area.x + 1, area.y + 1, area.columns - 2, area.rows - 2};
}

// ---- colours and output ----

static int cube_step(uint32_t channel) {
    return channel < 48 ? 0 : channel < 115 ? 1 : (int)(channel - 35) / 40;
}

int hn_cell_colour_rgb(int colour, int theme) {
    const hn_surface *surface = hn_surface_get((hn_theme)theme);
    return colour == HN_CELL_INK     ? -1
           : colour == HN_CELL_MUTED ? (int)surface->muted
           : colour == HN_CELL_ALARM ? (int)surface->tear
                                     : (int)hn_look_get(colour)->colour[theme];
}

int hn_cell_colour_256(int colour, int theme) {
    const int rgb = hn_cell_colour_rgb(colour, theme);
    return rgb < 0 ? -1
                   : 16 + 36 * cube_step((uint32_t)rgb >> 16 & 255) +
                         6 * cube_step((uint32_t)rgb >> 8 & 255) + cube_step((uint32_t)rgb & 255);
}

static int line_end(const hn_cells *c, int row) {
    int end = c->columns;
    while (end > 0) {
        const hn_cell *cell = &c->at[row * c->columns + end - 1];
        if ((cell->glyph[0] && strcmp(cell->glyph, " ") != 0) || cell->style & HN_CELL_REVERSE) {
            break;
        }
        end--;
    }
    return end;
}

static void put_attributes(hn_strbuf *b, const hn_cell *cell) {
    const int colour = hn_cell_colour_256(cell->colour, HN_THEME_DARK);
    hn_strbuf_add(b, "\033[0");
    if (cell->style & HN_CELL_BOLD) {
        hn_strbuf_add(b, ";1");
    }
    if (cell->style & HN_CELL_REVERSE) {
        hn_strbuf_add(b, ";7");
    }
    if (colour >= 0) {
        hn_strbuf_printf(b, ";38;5;%d", colour);
    }
    hn_strbuf_add(b, "m");
}

void hn_cells_text(hn_strbuf *b, const hn_cells *c, bool colours) {
    const hn_cell plain = {.colour = HN_CELL_INK};
    for (int row = 0; row < c->rows; row++) {
        const hn_cell *last = &plain;
        const int end = line_end(c, row);
        for (int x = 0; x < end; x++) {
            const hn_cell *cell = &c->at[row * c->columns + x];
            if (colours && (cell->colour != last->colour || cell->style != last->style)) {
                put_attributes(b, cell);
                last = cell;
            }
            hn_strbuf_add(b, cell->glyph[0] ? cell->glyph : " ");
        }
        hn_strbuf_add(b, last == &plain ? "\n" : "\033[0m\n");
    }
}
