// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_WIDTH_H
#define HN_TERMINAL_WIDTH_H
// What standard output is.

#include <stdbool.h>

/// Columns of the terminal behind standard output, else of the variable COLUMNS, else 80; 40 to
/// 300.
int hn_terminal_columns(void);
/// Standard output is a terminal that shows colours, and NO_COLOR is not set.
bool hn_terminal_colours(void);
#endif
