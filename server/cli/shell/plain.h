// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_PLAIN_H
#define HN_CLI_PLAIN_H
// Text for people on a terminal that shows no UTF-8: each character of a plot, a mark or a formula
// becomes one of ASCII, so that columns stay where they are.

#include "base/strbuf.h"

/// 1 when the locale names a character set that is not UTF-8: the first of LC_ALL, LC_CTYPE and
/// LANG that says anything. If none does, as in a container, nothing is known of the terminal
/// and 0 is returned. Each may be NULL.
int hn_plain_wanted(const char *lc_all, const char *lc_ctype, const char *lang);
/// Turns each power of ten, "×10⁻¹⁰", into "e-10", in place.
void hn_plain_powers(char *text);
/// The text with ASCII characters alone, in as many columns; what has no likeness becomes '?'.
void hn_plain_add(hn_strbuf *b, const char *utf8);
/// Appends text for people in ASCII: letters and signs of formulas by name ("theta_1", "<="), other
/// characters as hn_plain_add() has them. Blanks that stand two or more in a row give way, so that
/// columns stay where they are.
void hn_plain_text(hn_strbuf *b, const char *utf8);
#endif
