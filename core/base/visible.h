// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_VISIBLE_H
#define HN_BASE_VISIBLE_H
// Texts of files and names of files on a terminal, which would obey the control characters in them.

#include "base/strbuf.h"

#include <stdbool.h>
#include <stddef.h>

/// Returns the bytes of the control character that `text` begins with: 1 for U+0001 to U+001F and
/// U+007F, 2 for U+0080 to U+009F in UTF-8; 0 where it begins with none.
size_t hn_control_length(const char *text);
/// Returns whether the text holds a control character; line breaks and tabs are none unless
/// `of_one_line`.
bool hn_has_control(const char *text, bool of_one_line);
/// Adds the text with '?' for each control character; line breaks and tabs stay unless
/// `of_one_line`.
void hn_visible_add(hn_strbuf *b, const char *text, bool of_one_line);
#endif
