// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_WIDTH_H
#define HN_TERMINAL_WIDTH_H
// Properties of standard output: is it a terminal, and how wide.

#include <stdbool.h>

/// Columns of the terminal behind standard output, else of the variable COLUMNS, else 80; 40 to
/// 300.
int hn_terminal_columns(void);
/// Standard output is a terminal that shows colours, and NO_COLOR is not set.
bool hn_terminal_colours(void);
/// Columns that text for people may take: those of the terminal behind standard output, else of
/// the variable COLUMNS; 0: no limit, as in a pipe or after hn_terminal_be_wide().
int hn_terminal_limit(void);
/// Columns that prose may take: those of the terminal behind standard output, else of the variable
/// COLUMNS, else 80 as 'man' has it in a pipe; 0: no limit, after hn_terminal_be_wide().
int hn_terminal_prose(void);
/// The same as hn_terminal_limit() for messages: the terminal behind standard error, else COLUMNS.
int hn_terminal_error_limit(void);
/// From here on text for people is as wide as it is (--wide). For the whole process.
void hn_terminal_be_wide(void);
#endif
