// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_JSON_LINE_H
#define HN_BASE_JSON_LINE_H
// The line of a file on which a member stands that a JSON pointer names.

/// Returns the line (from 1) of the value at `pointer` ("/parts/0/ask"), or of the deepest value on
/// the way to it that is there. `text` is JSON that hn_json_text_check() has passed; a name in the
/// pointer is compared as it stands, without escapes.
int hn_json_line(const char *text, const char *pointer);

#endif
