// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_SECONDS_H
#define HN_TUI_SECONDS_H
// Times as people type them.

#include <stdbool.h>

/// Reads "0.01", "0,01", "0.01 s" or "20 ms" [s]; false: it is none, or not above 0;
/// a number too large for a double gives false and infinity.
bool hn_seconds_read(const char *text, double *out);
#endif
