// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_INTERPRET_H
#define HN_EXPR_TAPE_INTERPRET_H
// The interpreter of tapes. It exists in two forms that give the same bits and differ in how they
// get from one instruction to the next.

#include "expr/tape_code.h"

typedef enum hn_tape_dispatch {
    HN_TAPE_JUMPS,  ///< a computed jump at the end of each instruction: quicker on most processors
    HN_TAPE_SWITCH, ///< one switch for all: quicker where a computed jump is slow
    HN_TAPE_DISPATCHES
} hn_tape_dispatch;

/// Instructions of the process before the two forms are compared: some 1.5 ms, so that a short run
/// compares nothing.
enum { HN_TAPE_COMPARED_AFTER = 1000000 };
/// A shorter tape says little about the jumps between its instructions.
enum { HN_TAPE_COMPARED_LENGTH = 32 };

/// Evaluates the instructions of a tape on a prepared workspace, whatever native code there is. The
/// first HN_TAPE_COMPARED_AFTER instructions of the process take computed jumps; then both forms
/// are timed on the tape at hand for a millisecond, and the quicker one serves from there on. Safe
/// in several threads.
void hn_tape_interpret(const hn_tape *tape, double *work);

/// The same by one of the forms.
void hn_tape_interpret_by(hn_tape_dispatch form, const hn_tape *tape, double *work);

/// Returns whether the two forms have been compared, and which one serves now.
bool hn_tape_is_compared(hn_tape_dispatch *serves);

#endif
