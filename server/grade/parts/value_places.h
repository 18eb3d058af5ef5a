// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_VALUE_PLACES_H
#define HN_GRADE_PARTS_VALUE_PLACES_H
// The places of a reference formula at which something may have gone wrong: its nodes, and the
// formula again with one of them written anew.

#include "expr/graph.h"

#include <stdbool.h>

enum {
    HN_VALUE_NODES = 96, ///< distinct nodes of a reference that are visited
    HN_VALUE_ARGS = 24,  ///< terms of a sum
    HN_VALUE_DEPTH = 40
};

/// The distinct nodes of an expression.
typedef struct hn_value_places {
    int32_t node[HN_VALUE_NODES];
    int n;
    bool whole; ///< false: there are more of them, or longer sums, and the list is not complete
} hn_value_places;

/// Lists the nodes of `e`, each once.
void hn_value_places_find(hn_value_places *list, const hn_graph *g, hn_ex e);

/// Writes a node with the arguments a[0..n-1], which it may change. `c` is the coefficient of the
/// whole, to be changed too.
typedef hn_ex hn_value_write(hn_graph *g, hn_op op, hn_ex *a, int n, double *c, const void *user);

/// The expression again, in which `write` has written the node. `place` counts the places where the
/// node stands, from 1; 0: at all of them.
hn_ex hn_value_rewrite(hn_graph *g, hn_ex e, int32_t node, int place, hn_value_write *write,
                       const void *user);
#endif
