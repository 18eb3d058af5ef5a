// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_FORMULA_H
#define HN_EXPORT_FORMULA_H
// Expressions as formulas to read: equal factors are one power, quotients are fractions, a number
// before a sum is multiplied into its terms. For languages with hn_language.raised.

#include "base/strbuf.h"
#include "export/language.h"
#include "expr/graph.h"

typedef struct hn_formula {
    hn_strbuf *b;
    const hn_graph *g;
    const hn_language *language;
    const int *variable; ///< of each node: the number of its variable; 0: it is written out
    const char *prefix;  ///< of variables
} hn_formula;

/// Writes e. The buffer is marked failed when a product has more than 192 different factors.
void hn_formula_write(const hn_formula *f, hn_ex e);
/// Returns how many characters of the text are seen on the page: a command counts as one.
int hn_formula_length(const char *text);

#endif
