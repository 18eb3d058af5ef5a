// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/braille.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DOTS_ACROSS = 2, DOTS_DOWN = 4 };

/// Bit of the dot in column x and row y of a cell (Unicode 2800).
static const unsigned char bits[DOTS_DOWN][DOTS_ACROSS] = {
    {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

void hn_braille_init(hn_braille *c, int columns, int rows) {
    memset(c, 0, sizeof *c);
    c->columns = columns < HN_BRAILLE_COLUMNS ? columns : HN_BRAILLE_COLUMNS;
    c->rows = rows < HN_BRAILLE_ROWS ? rows : HN_BRAILLE_ROWS;
}

void hn_braille_line(hn_braille *c, double x0, double y0, double x1, double y1) {
    const double w = c->columns * DOTS_ACROSS - 1, h = c->rows * DOTS_DOWN - 1;
    const int n = (int)ceil(fmax(fabs(x1 - x0) * w, fabs(y1 - y0) * h)) + 1;
    for (int i = 0; i <= n; i++) {
        const double x = (x0 + (x1 - x0) * i / n) * w, y = (y0 + (y1 - y0) * i / n) * h;
        const int dx = (int)lround(x), dy = (int)lround(y);
        if (dx >= 0 && dy >= 0 && dx <= (int)w && dy <= (int)h) {
            c->dots[dy / DOTS_DOWN][dx / DOTS_ACROSS] |= bits[dy % DOTS_DOWN][dx % DOTS_ACROSS];
        }
    }
}

void hn_braille_put(hn_braille *c, double x, double y, const char *glyph) {
    const int column = (int)floor(x * c->columns), row = (int)floor(y * c->rows);
    const int i = column == c->columns ? column - 1 : column, j = row == c->rows ? row - 1 : row;
    if (i >= 0 && j >= 0 && i < c->columns && j < c->rows && !c->glyph[j][i][0]) {
        snprintf(c->glyph[j][i], HN_BRAILLE_GLYPH, "%s", glyph);
    }
}

void hn_braille_row(hn_strbuf *b, const hn_braille *c, int row) {
    for (int i = 0; i < c->columns; i++) {
        const unsigned dots = c->dots[row][i];
        if (c->glyph[row][i][0]) {
            hn_strbuf_add(b, c->glyph[row][i]);
        } else if (dots) {
            const char utf8[3] = {(char)0xe2, (char)(0xa0 | (dots >> 6)),
                                  (char)(0x80 | (dots & 0x3f))};
            hn_strbuf_add_n(b, utf8, 3);
        } else {
            hn_strbuf_add(b, " ");
        }
    }
}
