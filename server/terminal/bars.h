// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_BARS_H
#define HN_TERMINAL_BARS_H
// Horizontal bars in character cells, one a line: label, bar, value.

#include "terminal/cells.h"

enum { HN_BAR_TEXT = 96 };

typedef struct hn_bar {
    char label[HN_BAR_TEXT], value[HN_BAR_TEXT];
    double share; ///< of the full length, -1 to 1; a negative one is drawn lighter; NaN: no bar
    int colour;
} hn_bar;

/// Adds n bars of equal length in `columns` columns; labels and values stand in columns of their
/// own.
void hn_bars_text(hn_strbuf *b, const hn_bar *bars, int n, int columns, bool colours);
#endif
