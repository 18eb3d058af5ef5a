// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_NATIVE_COSTS_H
#define HN_SESSION_NATIVE_COSTS_H
// What native tapes cost and gain for one scene.

#include "base/strbuf.h"
#include "session/model/model.h"

/// Compiles the tape of accelerations and multipliers natively, waits for the compiler, and writes
/// an object: {"status": "compiled", "instructions", "emit_seconds", "compile_seconds" (0: kept
/// from before), "load_seconds", "interpreter_ns", "native_ns", "break_even_evaluations" (null:
/// never)}, or {"status": why the interpreter serves}.
void hn_model_native_put(hn_strbuf *b, const hn_model *model);
#endif
