// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_CODE_H
#define HN_EXPR_TAPE_CODE_H
// Instructions of the tape. Each is 16 bytes: what to do, where the result goes (v[0]), and up to
// six operands.
//
// Workspace: inputs first, then constants, then slots that are reused. A sum of two or three terms
// is one instruction; its key has a digit per term, in ascending order: 1 for + a b, 2 for + a, 3
// for - a b, 4 for - a. Sines and cosines of inputs come first, so that they can be found together.

#include "expr/lanes_sincos.h"
#include "expr/tape.h"
#include "expr/tape_ir.h"

#include <stdatomic.h>
#include <stdint.h>

/// code, key of a sum (or 0), operands, what is stored (a .. f are the operands)
// clang-format off
#define HN_TAPE_OPS(X)   \
    X(TAPE_END, 0, 0, 0) \
    HN_TAPE_OPS_BUT_END(X)
#define HN_TAPE_OPS_BUT_END(X)                       \
    X(TAPE_MUL, 0, 2, a * b)                          \
    X(TAPE_MUL3, 0, 3, (a * b) * c)                  \
    X(TAPE_MUL4, 0, 4, (a * b) * (c * d))            \
    X(TAPE_MUL_ADD, 0, 3, (a + b) * c)               \
    X(TAPE_MUL_SUB, 0, 3, (a - b) * c)               \
    X(TAPE_DIV, 0, 2, a / b)                         \
    X(TAPE_NEG, 0, 1, -a)                            \
    X(TAPE_SQRT, 0, 1, sqrt(a))                      \
    X(TAPE_SUM_11, 11, 4, a * b + c * d)              \
    X(TAPE_SUM_12, 12, 3, a * b + c)                  \
    X(TAPE_SUM_13, 13, 4, a * b - c * d)              \
    X(TAPE_SUM_14, 14, 3, a * b - c)                  \
    X(TAPE_SUM_22, 22, 2, a + b)                     \
    X(TAPE_SUM_23, 23, 3, a - b * c)                 \
    X(TAPE_SUM_24, 24, 2, a - b)                     \
    X(TAPE_SUM_111, 111, 6, (a * b + c * d) + e * f) \
    X(TAPE_SUM_112, 112, 5, (a * b + c * d) + e)     \
    X(TAPE_SUM_113, 113, 6, (a * b + c * d) - e * f) \
    X(TAPE_SUM_114, 114, 5, (a * b + c * d) - e)     \
    X(TAPE_SUM_122, 122, 4, (a * b + c) + d)         \
    X(TAPE_SUM_123, 123, 5, (a * b - d * e) + c)     \
    X(TAPE_SUM_124, 124, 4, (a * b - d) + c)         \
    X(TAPE_SUM_133, 133, 6, (a * b - c * d) - e * f) \
    X(TAPE_SUM_134, 134, 5, (a * b - c * d) - e)     \
    X(TAPE_SUM_144, 144, 4, (a * b - c) - d)         \
    X(TAPE_SUM_222, 222, 3, (a + b) + c)             \
    X(TAPE_SUM_223, 223, 4, (a - c * d) + b)         \
    X(TAPE_SUM_224, 224, 3, (a - c) + b)             \
    X(TAPE_SUM_233, 233, 5, a - (b * c + d * e))     \
    X(TAPE_SUM_234, 234, 4, a - (b * c + d))         \
    X(TAPE_SUM_244, 244, 3, a - (b + c))
// clang-format on

/// Instructions that are not one expression: sine and cosine of `a` to v[0] and v[2]; a call of the
/// operator v[7 - 1] with one or two arguments.
enum {
#define TAPE_ENUM(code, key, n, expression) code,
    HN_TAPE_OPS(TAPE_ENUM)
#undef TAPE_ENUM
        TAPE_SINCOS,
    TAPE_SIN,
    TAPE_COS,
    TAPE_CALL1,
    TAPE_CALL2,
    TAPE_CODES
};

enum { HN_TAPE_OPERANDS = 6, HN_TAPE_MAX_SLOTS = 65000 };

typedef struct hn_tape_instruction {
    uint16_t code;
    uint16_t v[7];
} hn_tape_instruction;

struct hn_tape {
    atomic_int *sharers;       ///< tapes that share the three arrays (tape_store.h); NULL: only one
    hn_tape_instruction *code; ///< ends in TAPE_END
    double *constants;         ///< loaded to work[n_inputs ...]
    uint16_t *outputs;         ///< slot of each output
    int32_t n_constants;
    int32_t n_angles;          ///< the first instructions: each TAPE_SINCOS of an input
    hn_lanes_sincos_four four; ///< finds four of those at once; NULL: each by itself
    hn_tape_info info;
    hn_tape_check check;            ///< of a tape without one: of no outputs
    struct hn_native_state *native; ///< NULL: the interpreter alone, see native.h
};

typedef struct hn_tape_code_info {
    const char *text; ///< what is stored, in terms of a .. f
    int key, n_operands;
} hn_tape_code_info;

/// Operands that an instruction reads: v[1] and those behind it.
int hn_tape_operands(const hn_tape_instruction *i);

/// The row of an instruction; for TAPE_SINCOS and the calls `text` is NULL.
hn_tape_code_info hn_tape_get_code_info(int code);

#endif
