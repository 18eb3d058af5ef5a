// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_PRINT_H
#define HN_EXPR_PRINT_H
// Expressions as text that hn_parse() reads back to the same node, as LaTeX, and as C.

#include "base/strbuf.h"
#include "expr/graph.h"

typedef enum hn_print_form { HN_PRINT_TEXT, HN_PRINT_LATEX, HN_PRINT_C } hn_print_form;

/// Appends e. Numbers with `digits` significant digits (0: as many as read back exactly). A node
/// that is used twice is written twice, so a deep graph can have no reasonable text: beyond 4 MiB
/// or 2,000 levels of nesting the buffer is marked failed.
void hn_print(hn_strbuf *b, const hn_graph *g, hn_ex e, hn_print_form form, int digits);

/// Appends a name as LaTeX: th12 becomes \theta_{12}, d_x \dot{x}, mass_b \mathrm{mass}_{b}.
void hn_print_latex_name(hn_strbuf *b, const char *name);

#endif
