// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_NATIVE_COSTS_H
#define HN_SESSION_NATIVE_COSTS_H
// The cost and the gain of native code for one scene.

#include "base/strbuf.h"
#include "session/model/model.h"

/// Compiles the tape of accelerations and multipliers to native code, waits for the compiler, and
/// writes an object: {"status": "compiled", "instructions", "emit_seconds", "compile_seconds" (0:
/// cached), "load_seconds", "interpreter_ns", "native_ns", "break_even_evaluations" (null: never)},
/// or {"status": the reason why the interpreter is used}.
void hn_model_native_put(hn_strbuf *b, const hn_model *model);
#endif
