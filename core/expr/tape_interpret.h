// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_INTERPRET_H
#define HN_EXPR_TAPE_INTERPRET_H
// The interpreter of tapes, and what it knows of each instruction.

#include "expr/tape_internal.h"

/// Evaluates the instructions of a tape on a prepared workspace, whatever native code there is.
void hn_tape_interpret(const hn_tape *tape, double *work);

typedef struct hn_tape_code_info {
    const char *text; ///< what is stored, in terms of a .. f
    int key, n_operands;
} hn_tape_code_info;

/// Operands that an instruction reads: v[1] and those behind it.
int hn_tape_operands(const hn_tape_instruction *i);

/// The row of an instruction; for TAPE_SINCOS and the calls `text` is NULL.
hn_tape_code_info hn_tape_get_code_info(int code);

#endif
