// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_NATIVE_CHECK_H
#define HN_EXPR_NATIVE_CHECK_H
// Compiled code is run beside the interpreter at several states before it is taken.

#include "expr/native_build.h"
#include "expr/native_emit.h"

/// Fills a workspace of single states: constants in their places, everything else zero.
void hn_native_prepare(const hn_tape *tape, double *work);
/// Fills the inputs of check number k. k = 0: all are 0; k = 1: all are 1; else numbers of -4 .. 4
/// by a congruential generator.
void hn_native_fill(double *inputs, int n, int k);
/// Returns whether compiled code gives the interpreter's bits at several states: the tape's
/// interpreter, or that of lanes. `calls` is the table that the code takes (HN_NATIVE_CALLS).
/// false: they differ, or memory is out.
bool hn_native_agrees(const hn_tape *tape, hn_native_form form, hn_native_code code,
                      const hn_native_call *calls);
#endif
