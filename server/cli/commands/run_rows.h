// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_RUN_ROWS_H
#define HN_CLI_RUN_ROWS_H
// The samples of `holonom run` as rows of CSV or NDJSON, each printed when it is there.

#include "base/strbuf.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

typedef struct hn_run_rows {
    bool ndjson;
    int width;      ///< [columns] 0: CSV or NDJSON; else a table for people that fits them
    double spacing; ///< of such a table: least time between two rows [s]; 0: not known
    int *shown;     ///< of that table: its columns; owned
    int *width_of;  ///< and how wide each is; owned
    int n_shown;
    bool begun;     ///< the head was printed
    bool failed;    ///< memory ran out
    int error;      ///< errno of the output; 0: it was written
    int n;          ///< columns
    double flushed; ///< when rows were last shown [s]
} hn_run_rows;

/// Prints the head: the names of the columns of a run document, which needs no samples.
void hn_run_rows_begin(hn_run_rows *rows, const cJSON *run);
/// Frees what a table needs.
void hn_run_rows_reset(hn_run_rows *rows);
/// Prints one row of n numbers; what is not finite is left empty, null in NDJSON.
void hn_run_rows_put(hn_run_rows *rows, const double *values, int n);

#endif
