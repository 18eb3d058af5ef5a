// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/dots.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ACROSS = 2, DOWN = 4 };

/// Bit of the dot in row y and column x of a cell (Unicode 2800).
static const unsigned char BITS[DOWN][ACROSS] = {
    {0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

bool hn_dots_resize(hn_dots *d, int columns, int rows) {
    const size_t n = (size_t)(columns > 0 ? columns : 0) * (size_t)(rows > 0 ? rows : 0);
    hn_dots_free(d);
    d->mask = calloc(n + 1, 1);
    d->colour = calloc(n + 1, 1);
    if (!d->mask || !d->colour) {
        hn_dots_free(d);
        return false;
    }
    d->columns = columns > 0 ? columns : 0;
    d->rows = rows > 0 ? rows : 0;
    return true;
}

void hn_dots_free(hn_dots *d) {
    free(d->mask);
    free(d->colour);
    *d = (hn_dots){0};
}

void hn_dots_set(hn_dots *d, int x, int y, int colour) {
    if (x >= 0 && y >= 0 && x < d->columns * ACROSS && y < d->rows * DOWN) {
        const int cell = y / DOWN * d->columns + x / ACROSS;
        d->mask[cell] |= BITS[y % DOWN][x % ACROSS];
        d->colour[cell] = (unsigned char)colour;
    }
}

/// Cuts the line to the box [low, high] along one coordinate; false: nothing is left.
static bool clip(double *a0, double *b0, double *a1, double *b1, double low, double high) {
    const double da = *a1 - *a0, db = *b1 - *b0;
    if ((*a0 < low && *a1 < low) || (*a0 > high && *a1 > high)) {
        return false;
    }
    for (int end = 0; end < 2; end++) {
        double *a = end ? a1 : a0, *b = end ? b1 : b0;
        const double edge = *a < low ? low : *a > high ? high : *a;
        if (edge != *a) {
            *b += db * (edge - *a) / da;
            *a = edge;
        }
    }
    return true;
}

void hn_dots_line(hn_dots *d, double x0, double y0, double x1, double y1, int colour, int on,
                  int off) {
    const double right = d->columns * ACROSS, bottom = d->rows * DOWN;
    if (!isfinite(x0 + y0 + x1 + y1) || !clip(&x0, &y0, &x1, &y1, -1, right) ||
        !clip(&y0, &x0, &y1, &x1, -1, bottom)) {
        return;
    }
    const int n = (int)ceil(fmax(fabs(x1 - x0), fabs(y1 - y0))) + 1;
    for (int i = 0; i <= n; i++) {
        if (off == 0 || i % (on + off) < on) {
            hn_dots_set(d, (int)lround(x0 + (x1 - x0) * i / n), (int)lround(y0 + (y1 - y0) * i / n),
                        colour);
        }
    }
}

// ---- forms ----

static void braille(unsigned mask, char out[4]) {
    out[0] = (char)0xe2;
    out[1] = (char)(0xa0 | (mask >> 6));
    out[2] = (char)(0x80 | (mask & 0x3f));
    out[3] = '\0';
}

/// Quadrants by upper left, upper right, lower left, lower right.
static const char *block(unsigned mask) {
    static const char *const quadrants[16] = {" ", "▘", "▝", "▀", "▖", "▌", "▞", "▛",
                                              "▗", "▚", "▐", "▜", "▄", "▙", "▟", "█"};
    const unsigned index = ((mask & 0x03) ? 1u : 0) | ((mask & 0x18) ? 2u : 0) |
                           ((mask & 0x44) ? 4u : 0) | ((mask & 0xa0) ? 8u : 0);
    return quadrants[index];
}

/// A character of about the shape of the dots: their rows decide, and whether they lean.
static const char *ascii(unsigned mask) {
    const unsigned rows = ((mask | mask >> 3) & 7u) | ((mask >> 6 | mask >> 7) & 1u) << 3;
    const bool left_top = mask & 0x03, right_bottom = mask & 0xa0;
    const bool right_top = mask & 0x18, left_bottom = mask & 0x44;
    if (left_top && right_bottom && !right_top && !left_bottom) {
        return "\\";
    }
    if (right_top && left_bottom && !left_top && !right_bottom) {
        return "/";
    }

    // else by the rows that are set
    switch (rows) {
    case 1:
        return "'";
    case 2:
    case 4:
    case 3:
    case 6:
        return "-";
    case 8:
    case 12:
        return "_";
    default:
        return "|";
    }
}

void hn_dots_show(hn_cells *c, hn_area area, const hn_dots *d, hn_dot_form form) {
    for (int y = 0; y < d->rows && y < area.rows; y++) {
        for (int x = 0; x < d->columns && x < area.columns; x++) {
            const int i = y * d->columns + x, at = (area.y + y) * c->columns + area.x + x;
            const bool off_page = area.y + y >= c->rows || area.x + x >= c->columns;
            if (!d->mask[i] || off_page || (c->at[at].glyph[0] && c->at[at].glyph[0] != ' ')) {
                continue;
            }
            char dots[4];
            braille(d->mask[i], dots);
            hn_cells_put(c, area, x, y, d->colour[i], HN_CELL_PLAIN,
                         form == HN_DOTS_BRAILLE  ? dots
                         : form == HN_DOTS_BLOCKS ? block(d->mask[i])
                                                  : ascii(d->mask[i]));
        }
    }
}
