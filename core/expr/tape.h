// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_H
#define HN_EXPR_TAPE_H
// A tape: straight-line code for chosen outputs of a graph. Operations that no output needs are
// left out, sin and cos of one argument share one instruction, and slots are reused. One
// instruction may hold two operations (a b + c d, ...), each rounded by itself. Operations are
// counted exactly. Evaluation allocates nothing and is the same to the last bit on every call. A
// tape is constant after compilation and may be shared by threads; slots are per thread.

#include "expr/graph.h"
#include "expr/tape_check.h"

#include <stddef.h>

typedef struct hn_tape hn_tape;

/// Exact counts of one evaluation.
typedef struct hn_tape_info {
    int n_inputs, n_outputs;
    /// arithmetic operations; sub counts as add, a lone sin or cos as one sincos
    int add, mul, div, sincos, sqrt, other;
    int ops;          ///< the sum of the line above
    int instructions; ///< what the interpreter dispatches
    int slots;        ///< doubles of workspace
} hn_tape_info;

/// Compiles n_out expressions; input i of the tape is symbols[i]. A symbol used but not listed is a
/// programmer's error. Returns owned in *out. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT (more than 65,000
/// live values). The graph keeps the code: the same outputs and inputs again are compiled once.
HN_MUST_CHECK hn_status hn_tape_compile(hn_graph *g, const hn_ex *outputs, int n_out,
                                        const int *symbols, int n_sym, hn_tape **out);
/// The same with a check of its answer, for hn_tape_run_checked(); its outputs are the first ones.
HN_MUST_CHECK hn_status hn_tape_compile_checked(hn_graph *g, const hn_ex *outputs, int n_out,
                                                const int *symbols, int n_sym,
                                                const hn_tape_check *check, hn_tape **out);
void hn_tape_free(hn_tape *tape); ///< what a compilation returned in *out; NULL is legal
hn_tape_info hn_tape_get_info(const hn_tape *tape);
/// Doubles that hn_tape_eval() needs as `work`; call hn_tape_prepare() once on a fresh workspace
/// (loads constants).
size_t hn_tape_work_size(const hn_tape *tape);
void hn_tape_prepare(const hn_tape *tape, double *work);
/// in (n_inputs) -> out (n_outputs). in and out must not overlap work.
void hn_tape_eval(const hn_tape *tape, const double *in, double *out, double *work);

/// The same without copying, for callers that keep a workspace: inputs are work[0 .. n_inputs-1]
/// and stay as they are; output k is work[hn_tape_output_slots()[k]] afterwards (borrowed,
/// n_outputs).
void hn_tape_run(const hn_tape *tape, double *work);
/// The same, and returns what is known of the tape's check: native code of a short tape looks, on
/// the way and for next to nothing; else it is left to the caller.
hn_tape_verdict hn_tape_run_checked(const hn_tape *tape, double *work);
const uint16_t *hn_tape_output_slots(const hn_tape *tape);

struct hn_strbuf;
/// One instruction a line, for tests and the curious.
void hn_tape_list(const hn_tape *tape, struct hn_strbuf *b);
#endif
