// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_CSV_H
#define HN_SESSION_CSV_H
// Writes cells of comma-separated tables (RFC 4180). The caller writes the commas between the
// cells.

#include "base/strbuf.h"

/// Writes the fewest digits that read back to the same double; writes nothing for NaN and infinity.
void hn_csv_number(hn_strbuf *b, double value);
/// Writes `text` in quotes, with inner quotes doubled. NULL counts as an empty text.
void hn_csv_text(hn_strbuf *b, const char *text);
#endif
