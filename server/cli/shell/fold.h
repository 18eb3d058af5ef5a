// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_FOLD_H
#define HN_CLI_FOLD_H
// Lines that fit the terminal: broken at blanks, never within a word nor between a number and
// its unit; a product that is longer than a line is broken behind one of its "*".

#include "base/strbuf.h"

/// Columns that a text takes: characters, not bytes; escape sequences of colours take none.
int hn_fold_width(const char *text, size_t n);
/// Bytes of the text's first line within `columns`: up to a blank, or up to the end of a word that
/// is longer, or behind a "*" of it.
size_t hn_fold_line(const char *text, int columns);
/// Adds the text with every line folded to `columns`; what follows a break is indented two columns
/// further than its line. columns 0: as it is.
void hn_fold_add(hn_strbuf *b, const char *text, int columns);
/// The same for paragraphs: lines that begin at the left edge go on there.
void hn_fold_prose(hn_strbuf *b, const char *text, int columns);
/// The same, and lines that are set in stay as they are: formulas, and answers to be copied.
void hn_fold_paragraphs(hn_strbuf *b, const char *text, int columns);
#endif
