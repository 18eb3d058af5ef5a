// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_DRAFT_H
#define HN_EXPR_TAPE_DRAFT_H
// Instructions before they have an order and slots: which operations of tape_ir.h share one. Sums
// take in products, products take in products and sums of two, a sine and the cosine of the same
// argument are one instruction.

#include "expr/tape_code.h"

/// One instruction; operands and results are IR nodes.
typedef struct hn_draft {
    uint16_t code;
    uint16_t n_operands;
    int32_t operand[HN_TAPE_OPERANDS];
    int32_t result, second; ///< second: the cosine of a sincos, else -1
    int32_t op;             ///< operator of a call
} hn_draft;

/// Common data of the nodes of a list. All zero is a legal empty one.
typedef struct hn_drafter {
    const hn_ir *ir;   ///< borrowed
    uint8_t *absorbed; ///< computed inside the instruction of its one user
    int32_t *partner;  ///< the cosine of a sine's argument and the reverse, -1: none
} hn_drafter;

/// Decides what is shared in a list whose live nodes are marked and whose sums have at most three
/// terms. Fails: HN_ERR_MEMORY; the drafter must be reset in any case.
HN_MUST_CHECK hn_status hn_drafter_create(const hn_ir *ir, hn_drafter *c);
void hn_drafter_reset(hn_drafter *c);

/// The instruction that computes a node; code TAPE_END for inputs and constants, which need none.
hn_draft hn_draft_make(const hn_drafter *c, int32_t id);

#endif
