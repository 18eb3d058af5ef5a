// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_CONSTRUCT_H
#define HN_EXPR_CONSTRUCT_H
// Builds expressions. Every constructor returns the canonical form that graph.h describes.
//
// fold.c (products, functions), sum.c (sums) and ops.c (derivatives of the operators) call each
// other: a product of powers simplifies to a sum, a sum takes products apart, a derivative is built
// by both. This circle is natural, and this header is its one door.

#include "expr/graph.h"

hn_ex hn_num(double value); ///< value must be finite
/// a + b, a - b, -a, k a, a b.
hn_ex hn_add(hn_graph *g, hn_ex a, hn_ex b);
hn_ex hn_sub(hn_graph *g, hn_ex a, hn_ex b);
hn_ex hn_neg(hn_ex a);
hn_ex hn_scale(double k, hn_ex a);
hn_ex hn_mul(hn_graph *g, hn_ex a, hn_ex b);
/// by a number: times the reciprocal; by zero: graph keeps 1/0 as a node and evaluates to inf
hn_ex hn_div(hn_graph *g, hn_ex a, hn_ex b);
hn_ex hn_sum(hn_graph *g, const hn_ex *terms, int n); ///< flat sum of n terms
/// Any operator of the table by its code; `args` holds hn_op_get_info(op)->arity expressions.
hn_ex hn_apply(hn_graph *g, hn_op op, const hn_ex *args);
hn_ex hn_sin(hn_graph *g, hn_ex a);
hn_ex hn_cos(hn_graph *g, hn_ex a);
hn_ex hn_sqrt(hn_graph *g, hn_ex a);
hn_ex hn_pow_int(hn_graph *g, hn_ex a, int power);

#endif
