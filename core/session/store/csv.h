// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_CSV_H
#define HN_SESSION_CSV_H
// Cells of tables as comma-separated values (RFC 4180). Between them the writer of a row puts its
// own commas.

#include "base/strbuf.h"

/// The fewest digits that read back to the same double; nothing for a number that is not finite.
void hn_csv_number(hn_strbuf *b, double value);
/// In quotes, quotes inside doubled. NULL: an empty text.
void hn_csv_text(hn_strbuf *b, const char *text);
#endif
