// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_NATIVE_EMIT_H
#define HN_EXPR_NATIVE_EMIT_H
// A tape written out as straight-line C.
//
// Each instruction becomes one constant with the very expression of the interpreter, so that a
// compiler without fused multiply-add gives the same bits. Functions of the operator table are
// called through the same pointers. Long tapes are cut into functions of a hundred instructions,
// since compilers take quadratic time; what crosses a cut goes through the workspace. In lanes a
// function works on all vectors of its blocks, and sine and cosine of a block are cuts.

#include "base/strbuf.h"
#include "expr/lanes_sincos.h"
#include "expr/tape_code.h"

/// The name of the function that the C text defines: hn_native_code.
#define HN_NATIVE_SYMBOL "hn_tape_native"

/// The states that the code evaluates: one, or HN_LANES of them (expr/lanes.h) by vectors of the
/// instruction set `form - HN_NATIVE_LANES`.
typedef int hn_native_form;
enum { HN_NATIVE_SINGLE, HN_NATIVE_LANES };

/// Adds the C text to `b`. It needs no header and no library but libm.
/// Fails: HN_ERR_UNSUPPORTED where a constant is not a number, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_native_emit(hn_strbuf *b, const hn_tape *tape, hn_native_form form);
#endif
