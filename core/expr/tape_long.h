// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_LONG_H
#define HN_EXPR_TAPE_LONG_H
// A tape evaluated in extended precision, for reference solutions.

#include "expr/tape.h"

/// Evaluates the instructions of the double tape in extended precision. `work` holds
/// hn_tape_work_size() long doubles, prepared once; inputs and outputs stand at the same slots as
/// in hn_tape_run(). Constants are those of the double tape, so both evaluate the same model. About
/// five times as slow.
void hn_tape_prepare_long(const hn_tape *tape, long double *work);
void hn_tape_run_long(const hn_tape *tape, long double *work);

#endif
