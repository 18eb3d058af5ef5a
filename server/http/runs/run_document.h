// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_DOCUMENT_H
#define HN_HTTP_RUN_DOCUMENT_H
// The document of a run by one method (hn_model_run_json()), and where its parts begin. They are
// looked for once, by the thread that made or read the document: a document may have 100 MB, which
// no event loop may walk through.

#include "base/strbuf.h"

#include <stdbool.h>
#include <stddef.h>

enum { HN_RUN_COLUMNS = 24, HN_RUN_COLUMN_NAME = 40 };

/// A column of samples: its name, and the array of its values.
typedef struct hn_run_column {
    char name[HN_RUN_COLUMN_NAME];
    const char *at;
} hn_run_column;

typedef struct hn_run_document {
    char *text; ///< owned
    size_t n;
    const char *samples, *samples_end; ///< the object, and the place behind it; NULL: none
    const char *incidents;             ///< the array; NULL: none
    const char *time;                  ///< the column t
    long long n_rows;
    int n_columns;
    hn_run_column columns[HN_RUN_COLUMNS]; ///< in their order
} hn_run_document;

/// Takes the text of a document. Returns false when memory is out, or the text, of a file, has
/// columns that no run has; hn_run_document_reset() afterwards in any case.
/// Cost: reads the whole text.
HN_MUST_CHECK bool hn_run_document_take(hn_run_document *d, hn_strbuf *text);
void hn_run_document_reset(hn_run_document *d);
/// Finds a column by its name; NULL when there is none.
const hn_run_column *hn_run_document_find_column(const hn_run_document *d, const char *name);
#endif
