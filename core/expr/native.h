// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_NATIVE_H
#define HN_EXPR_NATIVE_H
// Native tapes: tapes that are evaluated often are compiled by the system's C compiler in the
// background and replace the interpreter when they are ready, bit for bit; a NaN may be another
// NaN.
//
// One service for the process, off until hn_native_start(): it owns a thread and a queue. The
// interpreter serves until then, and for ever where there is no compiler, the compilation fails or
// takes too long, or the folder cannot be used. A tape is looked up in the folder after 2 ms of
// interpretation and compiled after 20 ms, so short runs start nothing. A tape of more than 40,000
// instructions stays with the interpreter, which is quicker there. Code stays loaded: a later tape
// that is equal uses it from its first evaluation. Before compiled code is taken it is run beside
// the interpreter at several states, and dropped where one bit differs.

#include "base/diag.h"
#include "expr/native_build.h"
#include "expr/native_emit.h"

#include <stdatomic.h>

struct hn_tape;

typedef struct hn_native_opts {
    const char *folder;   ///< where compiled tapes are kept; NULL: nothing is kept
    const char *compiler; ///< NULL: the first of gcc, clang, tcc in PATH
    double time_limit;    ///< [s] for one compilation, and again for each megabyte of C text; 60
    double look_after;    ///< [s] of interpretation before the folder is searched; 0.002
    double build_after;   ///< [s] of interpretation before the compiler is started; 0.02
} hn_native_opts;

/// Returns the options that the program uses. `folder` is borrowed.
hn_native_opts hn_native_opts_default(const char *folder);

/// Switches the service on for tapes compiled from now on. Call it once, before other threads
/// exist. The first tape that is long in use makes the service look for the folder and the compiler
/// and start its thread. If one of these is missing, the interpreter goes on, and
/// hn_native_reason() says why.
void hn_native_start(const hn_native_opts *opts);
/// In place of the start, where the service is wanted and cannot work: why.
void hn_native_stay_off(const char *why);
/// Stops the thread and a compilation under way. Tapes keep the code they have.
void hn_native_stop(void);
/// Keep the tapes that this thread compiles between the two calls with the interpreter, for work
/// that compares the times of methods: these must all run the same way. The calls may be nested.
void hn_native_suspend(void);
void hn_native_resume(void);
/// Waits until nothing is queued or under way.
void hn_native_wait(void);

/// Counts of the service so far; all zero while it is off.
typedef struct hn_native_counts {
    int ready;      ///< tapes that run natively
    int from_cache; ///< of these, found in the folder
    int failed;     ///< tapes that stay with the interpreter
} hn_native_counts;
hn_native_counts hn_native_get_counts(void);
/// Copies to `out` why the last tape stayed with the interpreter, or why the service cannot work;
/// "" if nothing went wrong.
void hn_native_reason(char out[HN_DIAG_MESSAGE]);

/// Costs of one tape, measured here and now.
typedef struct hn_native_costs {
    int instructions;
    double emit_seconds;    ///< writing the C text
    double compile_seconds; ///< wall clock of the compiler; 0: it was in the folder
    double load_seconds;    ///< loading and checking against the interpreter
    double interpreter_ns;  ///< one evaluation
    double native_ns;       ///< one evaluation
    double break_even;      ///< evaluations after which compilation has paid; inf: never
} hn_native_costs;

/// Compiles a tape now, waiting for it, and measures. Fails as the compilation does, with
/// HN_ERR_LIMIT where the tape is too long for machine code to pay, and with HN_ERR_UNSUPPORTED
/// while the service is off or cannot work; `diag` says why.
HN_MUST_CHECK hn_status hn_native_measure(const struct hn_tape *tape, hn_native_costs *costs,
                                          hn_diag *diag);

// ---- for tape.c, tape_compile.c and lanes.c ----

typedef struct hn_native_loaded hn_native_loaded;

/// The part of a tape that belongs to the service, for single states or for lanes. Shared by the
/// tape and the queue.
typedef struct hn_native_state {
    hn_native_form form;
    _Atomic(hn_native_code) code; ///< NULL: the interpreter serves
    const hn_native_call *calls;  ///< the functions of the operator table, as the code takes them
    atomic_int runs;              ///< evaluations by the interpreter; too few where threads race
    int look_at, build_at;        ///< `runs` at which to search the folder, and to compile
    atomic_int refs;
    struct hn_native_loaded *loaded; ///< what the code belongs to
} hn_native_state;

/// Returns the state of a new tape, or NULL while the service is off or memory is out.
hn_native_state *hn_native_state_create(const struct hn_tape *tape, hn_native_form form);
void hn_native_state_release(hn_native_state *s); ///< NULL is legal
/// Counts an evaluation by the interpreter. At `look_at` and at `build_at` evaluations the tape is
/// queued, as a copy. Does nothing where memory is out.
void hn_native_count(const struct hn_tape *tape, hn_native_state *s);
#endif
