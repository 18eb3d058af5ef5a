// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PLAIN_NUMBER_H
#define HN_HTTP_PLAIN_NUMBER_H
// Numbers in addresses, as JSON writes them. The C library reads more: blanks before a number, a
// plus, 0x10, inf.

#include <stdbool.h>

/// Reads a text that is a number and nothing else; `whole`: of digits, behind a minus perhaps.
/// Returns false where it is none; *out then stays.
bool hn_plain_number(const char *text, bool whole, double *out);
#endif
