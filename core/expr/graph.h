// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_GRAPH_H
#define HN_EXPR_GRAPH_H
// The expression graph: every quantity of a scene as a directed graph of interned nodes.
//
// construct.h builds expressions, diff.h differentiates and substitutes, print.h writes them as
// text and parse.h reads them.
//
// An expression is a coefficient times a node, {c, n}: negation and scaling cost nothing, and a
// sign never hides a common sub-expression. Node 0 is the constant one, so the number k is {k,
// HN_NODE_ONE} and zero is {0, HN_NODE_ONE} (always in that form). Constructors fold constants,
// drop zeros and ones, sort factors, normalise a sum to leading coefficient 1, cancel coefficients
// with a tolerance relative to their size (HN_CANCEL_TOL), combine c^2 + s^2 of one argument inside
// a sum when both carry the same remaining factors, and never expand a product of sums. A sum is
// flat, but a nested sum is flattened only where the result gets no longer. Equal structure means
// equal node id.
//
// The graph owns its nodes and never frees one before hn_graph_free(); a tape outlives its graph.
// When memory runs out, or an interrupt ends the work, the graph is marked failed, constructors
// return zero, and hn_graph_failed() says so: check once after building. A graph belongs to one
// thread.

#include "base/interrupt.h"
#include "base/status.h"
#include "expr/ops.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct hn_graph hn_graph;

typedef struct hn_ex {
    double c;  ///< coefficient
    int32_t n; ///< node
} hn_ex;

enum { HN_NODE_ONE = 0 };
#define HN_CANCEL_TOL 1e-13 ///< |c1 + c2| below this times max(|c1|, |c2|) counts as cancelled

hn_graph *hn_graph_create(void); ///< returns owned; NULL when memory is out
void hn_graph_free(hn_graph *g); ///< frees all nodes; NULL is legal
/// Returns whether the graph has failed: memory ran out, or the interrupt ended the work.
bool hn_graph_failed(const hn_graph *g);
/// Returns HN_OK, HN_ERR_MEMORY, or HN_ERR_STOPPED where the interrupt ended the work.
hn_status hn_graph_status(const hn_graph *g);
/// Sets the callback that building a graph and compiling a tape ask now and then whether to stop.
/// The data that it reads must outlive the graph.
void hn_graph_set_interrupt(hn_graph *g, hn_interrupt interrupt);
/// Asks it now. Returns true where the graph has been interrupted, which marks it failed until
/// hn_graph_go_on().
bool hn_graph_is_interrupted(hn_graph *g);
/// Returns whether it has been interrupted, without asking.
bool hn_graph_was_interrupted(const hn_graph *g);
/// Lets an interrupted graph grow again; one that is not stays as it is. The expression being built
/// was lost, and nothing wrong was kept: the same calls made again find the nodes that were there
/// and add the rest, with the same numbers.
void hn_graph_go_on(hn_graph *g);
int hn_graph_size(const hn_graph *g); ///< nodes so far

/// A named input: q1, v1, t, alpha, a parameter kept symbolic ... The same name gives the same
/// symbol. `latex` may be NULL (derived from the name). Symbols are numbered 0, 1, ... in order of
/// creation.
hn_ex hn_symbol(hn_graph *g, const char *name, const char *latex);
int hn_graph_find_symbol(const hn_graph *g, const char *name); ///< its number, or -1
int hn_graph_n_symbols(const hn_graph *g);
const char *hn_graph_symbol_name(const hn_graph *g, int symbol);
hn_ex hn_graph_symbol_expr(const hn_graph *g, int symbol);
int hn_ex_symbol(const hn_graph *g, hn_ex e); ///< symbol number if e is {1, symbol}, else -1

// ---- reading ----
bool hn_is_zero(hn_ex e);                  ///< exactly the number 0
bool hn_is_number(hn_ex e, double *value); ///< true if constant; value may be NULL
bool hn_ex_same(hn_ex a, hn_ex b);

/// One node, for printers, differentiation and the tape compiler. Arguments are borrowed.
typedef struct hn_node_view {
    hn_op op; ///< HN_OP_ONE, _SYMBOL, _SUM, _MUL or a function
    int n_args;
    /// sum: the terms; product: two factors with coefficient 1; function: its arguments
    const hn_ex *args;
    int symbol; ///< for HN_OP_SYMBOL
} hn_node_view;
hn_node_view hn_graph_node(const hn_graph *g, int32_t node);

/// True if e depends on the symbol.
bool hn_depends_on(const hn_graph *g, hn_ex e, int symbol);

#endif
