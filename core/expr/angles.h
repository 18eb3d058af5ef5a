// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_ANGLES_H
#define HN_EXPR_ANGLES_H
// Sums and differences of angles, for formulas to read: cos a cos b + sin a sin b is cos(a - b).

#include "expr/graph.h"

/// Rewrites n expressions in place: a sum that gets shorter when its products are multiplied out
/// and pairs of products of sines and cosines are joined becomes that shorter sum. Values stay,
/// but for rounding. A failure is the graph's (hn_graph_failed()), and HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_angles_join(hn_graph *g, hn_ex *e, int n);
/// Writes the terms of e, multiplied out, joined and added up where they are alike, to out. Returns
/// their number; 0 where there are more than `most`, or too many to multiply out. A failure is the
/// graph's.
int hn_angles_terms(hn_graph *g, hn_ex e, hn_ex *out, int most);

#endif
