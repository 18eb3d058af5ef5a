// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_SHORT_SPELLING_H
#define HN_TERMINAL_SHORT_SPELLING_H
// Spellings of methods as people read them.

#include <stddef.h>

/// Copies a spelling, its numbers of more than eight characters rounded to four digits; for lines
/// that are read, since what counts stays whole.
void hn_short_spelling(const char *spelling, char *out, size_t size);
#endif
