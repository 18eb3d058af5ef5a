// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_CODE_H
#define HN_EXPORT_CODE_H
// Expressions of a graph as statements of a programming language. A node that is used more than
// once is computed once, into a variable of its own; so is a piece that would make a line too long.

#include "base/strbuf.h"
#include "export/language.h"
#include "export/spelling.h"
#include "expr/graph.h"

/// One statement: `array`[row] or `array`[row][column] = value. Indices count from 0.
typedef struct hn_code_entry {
    const char *array;
    int row, column; ///< column -1: a vector
    hn_ex value;
} hn_code_entry;

/// Symbols of coordinates, velocities, and time.
typedef struct hn_code_symbols {
    const int *q, *v; ///< symbol numbers, nq and nv of them
    int nq, nv, t;
} hn_code_symbols;

/// Writes the entries in their order, each behind the shared pieces that it needs first. Every line
/// is indented by `indent` spaces. In a language of formulas to read, `symbols` groups pieces by
/// what they depend on; NULL: nobody says what symbols are.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT (more than 4 MiB of text).
HN_MUST_CHECK hn_status hn_code_write(hn_strbuf *b, const hn_graph *g, const hn_language *language,
                                      const hn_code_symbols *symbols, const hn_code_entry *entries,
                                      int n, int indent);

#endif
