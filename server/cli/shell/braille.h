// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_BRAILLE_H
#define HN_CLI_BRAILLE_H
// Lines on a terminal: each character cell is 2 x 4 dots of braille, and may hold a glyph instead.

#include "base/strbuf.h"

enum { HN_BRAILLE_COLUMNS = 100, HN_BRAILLE_ROWS = 40, HN_BRAILLE_GLYPH = 8 };

typedef struct hn_braille {
    int columns, rows;
    unsigned char dots[HN_BRAILLE_ROWS][HN_BRAILLE_COLUMNS];
    char glyph[HN_BRAILLE_ROWS][HN_BRAILLE_COLUMNS][HN_BRAILLE_GLYPH]; ///< "" for none
} hn_braille;

/// Empty, with at most the sizes above.
void hn_braille_init(hn_braille *c, int columns, int rows);
/// From the left and from the top, both 0..1; what lies outside is left out.
void hn_braille_line(hn_braille *c, double x0, double y0, double x1, double y1);
/// The first glyph in a cell stays.
void hn_braille_put(hn_braille *c, double x, double y, const char *glyph);
/// One row, without a line end.
void hn_braille_row(hn_strbuf *b, const hn_braille *c, int row);
#endif
