// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_LOWER_H
#define HN_EXPR_TAPE_LOWER_H
// From a graph to the operations of tape_ir.h.

#include "expr/tape_ir.h"

/// Brings n_out expressions of a graph into the form of tape_ir.h. Input i stands for symbols[i].
/// Fails: HN_ERR_MEMORY; `ir` must be reset in any case.
HN_MUST_CHECK hn_status hn_ir_lower(hn_ir *ir, hn_graph *g, const hn_ex *outputs, int n_out,
                                    const int *symbols, int n_sym);

#endif
