// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_DOTS_H
#define HN_TERMINAL_DOTS_H
// Lines finer than a character: 2 x 4 dots a cell, shown as braille, as quadrant blocks or in
// ASCII.

#include "terminal/cells.h"

typedef enum hn_dot_form { HN_DOTS_BRAILLE, HN_DOTS_BLOCKS, HN_DOTS_ASCII } hn_dot_form;

typedef struct hn_dots {
    int columns, rows; ///< cells
    unsigned char *mask, *colour;
} hn_dots;

/// No dots set; false: no memory. Start from {0}.
bool hn_dots_resize(hn_dots *d, int columns, int rows);
void hn_dots_free(hn_dots *d);
/// Sets the dot at (x, y), dots from the top left; what lies outside is left out. The last colour
/// of a cell wins.
void hn_dots_set(hn_dots *d, int x, int y, int colour);
/// A straight line between two places given in dots. `on`, `off`: lengths of its dashes in dots;
/// off 0: a full line.
void hn_dots_line(hn_dots *d, double x0, double y0, double x1, double y1, int colour, int on,
                  int off);
/// Puts the cells that have dots at the top left of the area; a cell that holds a character already
/// keeps it.
void hn_dots_show(hn_cells *c, hn_area area, const hn_dots *d, hn_dot_form form);
#endif
