// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_TABLE_H
#define HN_CLI_TABLE_H
// Tables for people: columns as wide as their widest cell, words to the left, numbers to the right.

#include "base/strbuf.h"

enum { HN_TABLE_COLUMNS = 12, HN_TABLE_CELL = 160 };

typedef struct hn_table {
    int n_columns, n_cells, cap;
    const char *heads[HN_TABLE_COLUMNS]; ///< static text
    int to_right[HN_TABLE_COLUMNS];
    char (*cells)[HN_TABLE_CELL];
    int failed;
} hn_table;

void hn_table_init(hn_table *t);
void hn_table_reset(hn_table *t);
void hn_table_column(hn_table *t, const char *head, int to_right);
/// The next cell, row by row from the left; longer than HN_TABLE_CELL - 1 bytes: cut, with an
/// ellipsis.
void hn_table_cell(hn_table *t, const char *format, ...) HN_PRINTF(2, 3);
/// A number with its unit and SI prefix, three digits; a value that is not finite is written as
/// "-".
void hn_table_quantity(hn_table *t, double value, const char *unit);
void hn_table_write(hn_strbuf *b, const hn_table *t);
#endif
