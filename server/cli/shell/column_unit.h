// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COLUMN_UNIT_H
#define HN_CLI_COLUMN_UNIT_H
// One unit for a column of quantities.

#include "cli/shell/table.h"

/// Writes the quantities of a column as texts: those of cells[first], cells[first + stride] ...
/// below n. `head` takes their common unit as " [mm]"; it stays empty where the cells differ in
/// their unit, and each cell then carries its own.
void hn_column_unit(hn_table_item *cells, int first, int stride, int n, char head[HN_TABLE_UNIT]);
#endif
