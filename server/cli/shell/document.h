// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_DOCUMENT_H
#define HN_CLI_DOCUMENT_H
// The tables for people are made from the same JSON documents that --json prints, so the two never
// disagree.

#include "base/strbuf.h"
#include "cli/shell/table.h"

#include <cjson/cJSON.h>

/// Parses what a document writer wrote, and frees the text; NULL when memory is out.
cJSON *hn_document_parse(hn_strbuf *text);
const cJSON *hn_document_get(const cJSON *object, const char *key);
double hn_document_number(const cJSON *object, const char *key);    ///< NaN when it is no number
const char *hn_document_text(const cJSON *object, const char *key); ///< "" when it is no string
/// A number as short as it can be and still read back to the same double; null is written as "".
void hn_document_put_number(hn_strbuf *b, const cJSON *number);

/// One column of a list: the head, the member, and how it is written (unit NULL: as text).
typedef struct hn_list_column {
    const char *head, *key, *unit;
} hn_list_column;
/// A table with one row for each object of the array.
void hn_document_list(hn_strbuf *b, const cJSON *array, const hn_list_column *columns, int n);
/// Words for a member for people; its path is "start.dof", of a column "loops.why".
typedef struct hn_outline_word {
    const char *path, *words;
} hn_outline_word;
/// An outline of any document: a line for each member, lists of numbers and words in one line,
/// lists of objects as tables. Members that `words` does not list (it ends with a NULL path) keep
/// their names.
void hn_document_outline(hn_strbuf *b, const cJSON *object, const hn_outline_word *words);
/// A matrix with names for rows and columns (either may be NULL).
void hn_document_matrix(hn_strbuf *b, const char *name, const cJSON *rows, const cJSON *row_names,
                        const cJSON *column_names);
#endif
