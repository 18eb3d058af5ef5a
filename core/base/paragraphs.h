// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_PARAGRAPHS_H
#define HN_BASE_PARAGRAPHS_H
// Prose whose lines were broken by hand, for readers of another width.

#include "base/strbuf.h"

/// Adds the text with the lines of each paragraph joined by blanks. An empty line ends a paragraph;
/// a line that begins with a blank (a formula) stays a line of its own. Line ends at the text's end
/// are kept.
void hn_paragraphs_join(hn_strbuf *b, const char *text);
#endif
