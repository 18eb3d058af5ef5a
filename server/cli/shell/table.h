// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_TABLE_H
#define HN_CLI_TABLE_H
// Tables for people: words to the left, numbers aligned at the decimal point, units in the head.
//
// A table that is wider than the terminal first folds its columns of words into several lines and
// then leaves its least important columns out; a line below the table names them.

#include "base/strbuf.h"

#include <stdbool.h>

enum { HN_TABLE_COLUMNS = 16, HN_TABLE_CELL = 400, HN_TABLE_UNIT = 24 };

/// One cell: a text, or a number with a unit that becomes a text when the table is written.
typedef struct hn_table_item {
    char text[HN_TABLE_CELL], unit[HN_TABLE_UNIT];
    double value;
    bool is_quantity, is_bad;
} hn_table_item;

typedef struct hn_table {
    int n_columns, n_cells, cap;
    int width; ///< [columns] that a line may take; 0: no limit
    bool colours;
    const char *heads[HN_TABLE_COLUMNS]; ///< static text
    int to_right[HN_TABLE_COLUMNS];
    int spare[HN_TABLE_COLUMNS]; ///< 0: never left out; else the smallest goes first
    hn_table_item *cells;
    int n_left_out; ///< columns that the table written last had no room for
    int failed;
} hn_table;

/// An empty table as wide as standard output (hn_terminal_limit()).
void hn_table_init(hn_table *t);
void hn_table_reset(hn_table *t);
/// Adds a column. If there is no room, columns are left out from the right, numbers first, up to
/// the third, unless hn_table_spare() gives another order.
void hn_table_column(hn_table *t, const char *head, int to_right);
/// The column added last is left out before those of a larger order; 0: never.
void hn_table_spare(hn_table *t, int order);
/// The next cell, row by row from the left; longer than HN_TABLE_CELL - 1 bytes: cut, with an
/// ellipsis.
void hn_table_cell(hn_table *t, const char *format, ...) HN_PRINTF(2, 3);
/// A number of three digits. The quantities of a column share one unit, which is written in the
/// head; where their sizes differ by more than 10^4 they are written with a power of ten. A value
/// that is not finite is written as "-".
void hn_table_quantity(hn_table *t, double value, const char *unit);
/// Marks the cell added last as bad news: red where the terminal has colours.
void hn_table_bad(hn_table *t);
void hn_table_write(hn_strbuf *b, hn_table *t);
#endif
