// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_FORMULA_H
#define HN_EXPORT_FORMULA_H
// Expressions as formulas to read: equal factors are one power, quotients are fractions, a number
// before a sum is multiplied into its terms. For languages with hn_language.raised.

#include "base/strbuf.h"
#include "export/language.h"
#include "expr/graph.h"

/// Dependence of a piece: it decides the first letter of the name and the group of formulas.
typedef enum hn_piece_kind {
    HN_PIECE_CONSTANT, ///< parameters alone
    HN_PIECE_POSITION, ///< coordinates or time; also where nobody says what symbols are
    HN_PIECE_VELOCITY, ///< velocities
    HN_PIECE_KINDS,
    HN_PIECE_NUMBER = HN_PIECE_KINDS ///< a number of many digits (export/numbers.h)
} hn_piece_kind;

typedef struct hn_formula {
    hn_strbuf *b;
    const hn_graph *g;
    const hn_language *language;
    const int *variable;       ///< of each node: its variable; 0: it is written out
    const char *const *prefix; ///< of the variables of each kind
} hn_formula;

/// A variable: its number among all, from 1 on, and its kind.
int hn_formula_variable(int number, hn_piece_kind kind);
/// Its name: the prefix of its kind and its number.
void hn_formula_variable_name(const char *const *prefix, int variable, char out[32]);

/// Writes e. The buffer is marked failed when a product has more than 192 different factors.
void hn_formula_write(const hn_formula *f, hn_ex e);
/// Returns how many characters of the text are seen on the page: a command counts as one.
int hn_formula_length(const char *text);

#endif
