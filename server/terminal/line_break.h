// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_LINE_BREAK_H
#define HN_TERMINAL_LINE_BREAK_H
// Places where a line of text may be broken.

#include <stdbool.h>
#include <stddef.h>

/// Returns whether a line may end before the blank text[at]: not between a number and its unit, as
/// in "27 mm" or "4 rad/s", nor beside an equals sign, as in "l1 = 0.5". If no other blank is,
/// those who fold break there all the same.
bool hn_line_may_break(const char *text, size_t at);
#endif
