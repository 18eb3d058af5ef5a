// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_NATIVE_BUILD_H
#define HN_EXPR_NATIVE_BUILD_H
// The system's C compiler as a child process with limits, and the folder that keeps what it made.

#include "base/diag.h"
#include "expr/lanes_sincos.h"
#include "expr/ops.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { HN_NATIVE_PATH = 512 };

/// Places in `call` of compiled code: first hn_op_info.value by operator, then an hn_lanes_sincos
/// for each instruction set, then the hn_lanes_sincos_four, if there is one.
enum {
    HN_NATIVE_SINCOS = HN_OP_COUNT,
    HN_NATIVE_FOUR = HN_NATIVE_SINCOS + HN_LANES_SETS,
    HN_NATIVE_CALLS
};

/// Compiled code: evaluates a tape on its workspace. Returns an hn_tape_verdict.
typedef double (*hn_native_call)(const double *);
typedef int (*hn_native_code)(double *work, const hn_native_call *call);

/// A compiler and the folder for its results.
typedef struct hn_native_builder {
    char compiler[HN_NATIVE_PATH]; ///< absolute path
    char folder[HN_NATIVE_PATH];
    double time_limit;   ///< [s] wall clock for one compilation, and again for each megabyte
    uint64_t identity;   ///< hash of the compiler's file, its flags and this program
    atomic_bool *ending; ///< a compilation under way is killed once this is set; may be NULL
} hn_native_builder;

/// Fills a builder: makes the folder (mode 0700) if it is missing and looks for the compiler, gcc,
/// clang and tcc in this order in PATH unless `compiler` names one.
/// Fails: HN_ERR_UNSUPPORTED (no compiler), HN_ERR_IO (the folder cannot be made, belongs to
/// somebody else, or others may write to it).
HN_MUST_CHECK hn_status hn_native_builder_init(hn_native_builder *b, const char *folder,
                                               const char *compiler, double time_limit,
                                               hn_diag *diag);

/// Loads what an earlier compilation of this text left in the folder.
/// A file is taken only if it is a regular file of this user that nobody else may write, ends in
/// the checksum of its bytes, and was made for this text by this compiler.
/// Returns owned in *handle (dlclose). Fails: HN_ERR_IO: there is none, or none that may be taken.
HN_MUST_CHECK hn_status hn_native_load(const hn_native_builder *b, const char *text, size_t n,
                                       void **handle, hn_native_code *code);

/// Compiles the text and puts the result into the folder, as a whole or not at all; several
/// processes may do so at once. *seconds: wall clock of the compiler.
/// Fails: HN_ERR_STOPPED (time limit), HN_ERR_UNSUPPORTED (the compiler reports an error),
/// HN_ERR_IO.
HN_MUST_CHECK hn_status hn_native_build(const hn_native_builder *b, const char *text, size_t n,
                                        double *seconds, hn_diag *diag);
#endif
