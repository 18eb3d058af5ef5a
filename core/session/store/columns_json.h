// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COLUMNS_JSON_H
#define HN_SESSION_COLUMNS_JSON_H
// Members of an open JSON object that several documents have in common: names of columns, and
// tables row by row.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

/// Key "coordinates": names of the scene's coordinates in the order of q and v of a document.
void hn_columns_put_coordinates(hn_strbuf *b, const hn_system *sys);
/// Key "rates": names of their rates.
void hn_columns_put_rates(hn_strbuf *b, const hn_system *sys);
/// Key "rows": names of the closure rows in the order of lambda.
void hn_columns_put_rows(hn_strbuf *b, const hn_system *sys);
/// A list of rows; values row-major, n x width.
void hn_columns_put_table(hn_strbuf *b, const char *key, const double *values, long long n,
                          int width);
#endif
