// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_CELLS_H
#define HN_TERMINAL_CELLS_H
// A page of character cells. Every view of the terminal workbench and every plot of the command
// line draws into one; what becomes of it (a screen, or lines of text) is decided afterwards, so
// that a frame can be tested without a terminal.

#include "base/strbuf.h"

#include <stdbool.h>

/// Colours of a cell: 0 .. 8 are the slots of render/look.h (8: the reference solution).
enum { HN_CELL_INK = 9, HN_CELL_MUTED, HN_CELL_ALARM, HN_CELL_COLOURS };
enum { HN_CELL_PLAIN = 0, HN_CELL_BOLD = 1, HN_CELL_REVERSE = 2 };

/// UTF-8 of one character, and of one that combines with it.
enum { HN_CELL_GLYPH = 8 };

typedef struct hn_cell {
    char glyph[HN_CELL_GLYPH]; ///< "": blank
    unsigned char colour, style;
} hn_cell;

typedef struct hn_cells {
    int columns, rows;
    hn_cell *at; ///< row by row; NULL while empty
} hn_cells;

/// A part of a page; views clip to theirs.
typedef struct hn_area {
    int x, y, columns, rows;
} hn_area;

/// Blank cells of a new size; false: no memory (the page is then empty). Start from {0}.
bool hn_cells_resize(hn_cells *c, int columns, int rows);
void hn_cells_free(hn_cells *c);
void hn_cells_clear(hn_cells *c);

/// Writes one line of UTF-8 at (x, y) of an area, cut at its right edge; characters that take no
/// column join the one before.
/// Returns the columns used. Control characters become blanks.
int hn_cells_put(hn_cells *c, hn_area area, int x, int y, int colour, int style, const char *text);
int hn_cells_printf(hn_cells *c, hn_area area, int x, int y, int colour, int style,
                    const char *format, ...) HN_PRINTF(7, 8);
/// Writes text in lines no longer than the area, broken at blanks, from row y on; returns the row
/// after the last one.
int hn_cells_fold(hn_cells *c, hn_area area, int y, int colour, const char *text);
/// Puts text that ends in an ellipsis where it does not fit, cut at a blank where there is one in
/// its second half.
void hn_cells_put_fitted(hn_cells *c, hn_area area, int x, int y, int colour, int style,
                         const char *text);
/// Folds text into an area; where it does not fit, its last line ends in an ellipsis.
void hn_cells_fold_fitted(hn_cells *c, hn_area area, int colour, const char *text);
/// Writes what stands in an area in reverse.
void hn_cells_mark(hn_cells *c, hn_area area);
/// The rows that hn_cells_fold() needs for the text in lines of at most `columns` (at least 1).
int hn_text_rows(const char *text, int columns);
/// A frame with a title along the edge of the area; returns what is inside.
hn_area hn_cells_frame(hn_cells *c, hn_area area, const char *title);
/// The columns that a text takes.
int hn_text_columns(const char *text);

/// The page as lines, blanks at their ends left out. `colours`: with ANSI sequences for bold,
/// reverse and 256 colours.
void hn_cells_text(hn_strbuf *b, const hn_cells *c, bool colours);
/// The colour as 0xRRGGBB in the given theme (hn_theme); -1 for ink: the terminal's own.
int hn_cell_colour_rgb(int colour, int theme);
/// The same as one of the 256 of a terminal.
int hn_cell_colour_256(int colour, int theme);
#endif
