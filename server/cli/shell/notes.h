// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_NOTES_H
#define HN_CLI_NOTES_H
// Remarks for people on standard error.

#include "base/strbuf.h"

/// Writes whole lines on standard error, folded to the terminal behind it; control characters, as
/// of a file's name, stand as '?'.
void hn_cli_note(const char *format, ...) HN_PRINTF(1, 2);
/// The same for lines that are there already.
void hn_cli_note_lines(const hn_strbuf *lines);
#endif
