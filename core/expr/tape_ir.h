// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_IR_H
#define HN_EXPR_TAPE_IR_H
// The form between graph and tape: operations without coefficients, interned like the graph's
// nodes.
//
// A graph node n is represented by {k, i}: n = k * (value of IR node i). The factor k travels on
// through products and is paid for, as a multiplication by a constant, only where a sum, a function
// or an output cannot take it in. A sum's terms carry signs, so that negation is free inside sums.

#include "expr/graph.h"

#include <stddef.h>

typedef enum hn_ir_kind {
    HN_IR_CONST,
    HN_IR_INPUT,
    HN_IR_MUL,
    HN_IR_DIV,
    HN_IR_SUM,
    HN_IR_NEG,
    HN_IR_CALL
} hn_ir_kind;

typedef struct hn_ir_arg {
    int32_t node;
    int32_t sign; ///< +1 or -1; sums only
} hn_ir_arg;

typedef struct hn_ir_node {
    uint8_t kind;
    uint8_t op;     ///< hn_op of a call
    uint8_t single; ///< made for one use in the graph: may be taken apart
    uint8_t live;
    int32_t n_args, first; ///< arguments in hn_ir.args
    int32_t uses;          ///< by live nodes and outputs
    int32_t input;
    double value; ///< of a constant
} hn_ir_node;

typedef struct hn_ir {
    hn_ir_node *nodes;
    int32_t n, cap;
    hn_ir_arg *args;
    int32_t n_args, cap_args;
    int32_t *table;
    uint32_t table_size;
    int32_t *outputs; ///< IR node of each output
    int32_t n_outputs;
    int failed; ///< memory ran out
} hn_ir;

/// Frees what the instructions hold; the list is then empty.
void hn_ir_reset(hn_ir *ir);

// Each gives the node's id and sets *fresh (may be NULL) to 1 if it was new. They return 0 once
// memory is out.
int32_t hn_ir_const(hn_ir *ir, double value);
int32_t hn_ir_input(hn_ir *ir, int32_t input);
int32_t hn_ir_mul(hn_ir *ir, int32_t a, int32_t b, int *fresh);
int32_t hn_ir_div(hn_ir *ir, int32_t a, int32_t b, int *fresh);
int32_t hn_ir_sum(hn_ir *ir, const hn_ir_arg *args, int32_t n, int *fresh);
int32_t hn_ir_neg(hn_ir *ir, int32_t a);
int32_t hn_ir_call(hn_ir *ir, hn_op op, const int32_t *args, int n, int *fresh);
/// The product a b if it exists, else -1.
int32_t hn_ir_find_mul(const hn_ir *ir, int32_t a, int32_t b);

/// Opens sums inside sums that nothing else uses; needs the counts of hn_ir_mark_live().
void hn_ir_flatten_sums(hn_ir *ir);
/// Cuts long sums into pieces of at most three terms that one instruction takes.
void hn_ir_split_sums(hn_ir *ir);
/// Marks what the outputs need and counts uses.
void hn_ir_mark_live(hn_ir *ir);

#endif
