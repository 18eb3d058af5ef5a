// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_NUMBERS_H
#define HN_EXPORT_NUMBERS_H
// Long numbers of formulas to read, in a table of their own.

#include "base/strbuf.h"
#include "export/language.h"

/// Gives a name to each number of ten digits or more that the formulas from byte `from` of b on use
/// three times or more: prefix and its place in the table, which is put before them. For languages
/// with hn_language.numbers. A failure is the buffer's.
void hn_code_name_numbers(hn_strbuf *b, size_t from, const hn_language *language,
                          const char *prefix);

#endif
