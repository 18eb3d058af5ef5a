// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COLUMNS_JSON_H
#define HN_SESSION_COLUMNS_JSON_H
// Writes members that several documents share into an open JSON object: names of columns, and
// tables row by row.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

/// Writes "coordinates": the names of the scene's coordinates, in the order of q and v.
void hn_columns_put_coordinates(hn_strbuf *b, const hn_system *sys);
/// Writes "rates": the names of the coordinates' rates, in the same order.
void hn_columns_put_rates(hn_strbuf *b, const hn_system *sys);
/// Writes "rows": the names of the constraint rows, in the order of lambda.
void hn_columns_put_rows(hn_strbuf *b, const hn_system *sys);
/// Writes `key`: a list of n rows. `values` is row-major, n x width.
void hn_columns_put_table(hn_strbuf *b, const char *key, const double *values, long long n,
                          int width);
#endif
