// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_INTERPRET_H
#define HN_EXPR_TAPE_INTERPRET_H
// The interpreter of tapes.

#include "expr/tape_code.h"

/// Evaluates the instructions of a tape on a prepared workspace, whatever native code there is.
void hn_tape_interpret(const hn_tape *tape, double *work);

#endif
