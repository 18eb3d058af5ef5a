// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_DIFF_H
#define HN_EXPR_DIFF_H
// Exact differentiation, substitution and evaluation of expressions, by sweeps over the graph.

#include "expr/graph.h"

/// d e / d symbol for each of n_sym symbols: out[i]. Forward over the whole graph, results
/// interned.
void hn_diff(hn_graph *g, hn_ex e, const int *symbols, int n_sym, hn_ex *out);
/// Directional derivative of n expressions in the direction seed[i] along symbols[i] (forward mode,
/// one sweep).
void hn_diff_forward(hn_graph *g, const hn_ex *e, int n, const int *symbols, const hn_ex *seed,
                     int n_sym, hn_ex *out);
/// Gradient of one expression by reverse mode, one sweep: out[i] = d e / d symbols[i].
void hn_diff_reverse(hn_graph *g, hn_ex e, const int *symbols, int n_sym, hn_ex *out);
/// e with each symbols[i] replaced by with[i], all at once; n expressions in, n out.
void hn_substitute(hn_graph *g, const hn_ex *e, int n, const int *symbols, const hn_ex *with,
                   int n_sym, hn_ex *out);
/// Value at x[symbol] (array by symbol number), straight from the graph: slow, for checks and
/// constants.
double hn_graph_eval(hn_graph *g, hn_ex e, const double *x);
/// The same at n points, of which point i begins at x[i * stride]: out[i]. NaN where memory fails.
void hn_graph_eval_all(hn_graph *g, hn_ex e, const double *x, int n, int stride, double *out);

#endif
