// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_COMMA_LIST_H
#define HN_GRADE_COMMA_LIST_H
// Lists of numbers with decimal commas in one text, as "1,5; 2,3", "[1,5 2,3]" or "(1,5 m; 2 m)".

#include <cjson/cJSON.h>
#include <stdbool.h>

/// Reads a text as n entries that semicolons, line ends or blanks part; owned, each entry a text.
/// NULL: the text has no decimal comma, or not n entries of which each has at most one comma, with
/// a digit before and behind it.
cJSON *hn_comma_list_read(const char *text, int n);
/// Returns whether a comma of the text stands between two digits: it may stand for decimals, or
/// part two entries.
bool hn_comma_list_is_unclear(const char *text);
#endif
