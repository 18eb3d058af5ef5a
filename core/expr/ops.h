// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_OPS_H
#define HN_EXPR_OPS_H
// The one table of operators: name as typed, arity, cost, value, derivative, text and LaTeX form, C
// form. The parser, the folder, differentiation, the printers and the tape all read it.

#include <stdbool.h>

/// code, name as typed, arity (-1: any), 1 if people may type name(...), parity, value_ and
/// partials_ suffix (ops.c), LaTeX, C (#1 and #2 stand for the arguments)
#define HN_OP_LIST(X)                                                                      \
    X(HN_OP_ONE, "1", 0, 0, NONE, none, "1", "1.0")                                        \
    X(HN_OP_SYMBOL, "symbol", 0, 0, NONE, none, "", "")                                    \
    X(HN_OP_SUM, "+", -1, 0, NONE, none, "", "")                                           \
    X(HN_OP_MUL, "*", 2, 0, NONE, mul, "", "")                                             \
    X(HN_OP_RECIP, "recip", 1, 0, ODD, recip, "\\frac{1}{#1}", "1.0 / (#1)")               \
    X(HN_OP_SQRT, "sqrt", 1, 1, NONE, sqrt, "\\sqrt{#1}", "sqrt(#1)")                      \
    X(HN_OP_SIN, "sin", 1, 1, ODD, sin, "\\sin", "sin(#1)")                                \
    X(HN_OP_COS, "cos", 1, 1, EVEN, cos, "\\cos", "cos(#1)")                               \
    X(HN_OP_TAN, "tan", 1, 1, ODD, tan, "\\tan", "tan(#1)")                                \
    X(HN_OP_ASIN, "asin", 1, 1, ODD, asin, "\\arcsin", "asin(#1)")                         \
    X(HN_OP_ACOS, "acos", 1, 1, NONE, acos, "\\arccos", "acos(#1)")                        \
    X(HN_OP_ATAN, "atan", 1, 1, ODD, atan, "\\arctan", "atan(#1)")                         \
    X(HN_OP_ATAN2, "atan2", 2, 1, NONE, atan2, "\\operatorname{atan2}", "atan2(#1, #2)")   \
    X(HN_OP_SINH, "sinh", 1, 1, ODD, sinh, "\\sinh", "sinh(#1)")                           \
    X(HN_OP_COSH, "cosh", 1, 1, EVEN, cosh, "\\cosh", "cosh(#1)")                          \
    X(HN_OP_TANH, "tanh", 1, 1, ODD, tanh, "\\tanh", "tanh(#1)")                           \
    X(HN_OP_EXP, "exp", 1, 1, NONE, exp, "\\exp", "exp(#1)")                               \
    X(HN_OP_LOG, "log", 1, 1, NONE, log, "\\ln", "log(#1)")                                \
    X(HN_OP_POW, "pow", 2, 1, NONE, pow, "{#1}^{#2}", "pow(#1, #2)")                       \
    X(HN_OP_ABS, "abs", 1, 1, EVEN, abs, "\\left|#1\\right|", "fabs(#1)")                  \
    X(HN_OP_SIGN, "sign", 1, 1, ODD, sign, "\\operatorname{sign}",                         \
      "(double)(((#1) > 0) - ((#1) < 0))")                                                 \
    X(HN_OP_STEP, "step", 1, 1, NONE, step, "\\operatorname{step}", "(double)((#1) >= 0)") \
    X(HN_OP_MIN, "min", 2, 1, NONE, min, "\\min", "((#1) <= (#2) ? (#1) : (#2))")          \
    X(HN_OP_MAX, "max", 2, 1, NONE, max, "\\max", "((#1) >= (#2) ? (#1) : (#2))")

typedef enum hn_op {
#define HN_OP_ENUM(code, ...) code,
    HN_OP_LIST(HN_OP_ENUM)
#undef HN_OP_ENUM
        HN_OP_COUNT
} hn_op;

struct hn_graph;
struct hn_ex;

/// f(-x) = -f(x), f(-x) = f(x), or neither.
typedef enum hn_parity { HN_PARITY_NONE, HN_PARITY_ODD, HN_PARITY_EVEN } hn_parity;

/// Value of the operator; `x` holds its arguments. Takes the one-sided convention at a kink:
/// sign(0) = 0, step(0) = 1. NaN in gives NaN out.
typedef double (*hn_op_value)(const double *x);
/// The same in extended precision.
typedef long double (*hn_op_value_long)(const long double *x);
/// Writes d f / d args[i] to partial[i]; `self` is f(args) itself, so that exp, tan or sqrt reuse
/// it. abs' = sign, sign' = step' = 0, and of two equal arguments min and max follow the first.
typedef void (*hn_op_partials)(struct hn_graph *g, const struct hn_ex *self,
                               const struct hn_ex *args, struct hn_ex *partial);

typedef struct hn_op_info {
    const char *name;            ///< as typed
    int arity;                   ///< -1: any number
    bool typed;                  ///< people may write name(...) in a formula
    hn_parity parity;            ///< of a function of one argument
    hn_op_value value;           ///< NULL for one, symbol and sum
    hn_op_value_long value_long; ///< likewise
    hn_op_partials partials;     ///< NULL for one, symbol and sum
    const char *latex;           ///< macro or form of a function
    const char *c_name;          ///< expression form in C with #1 and #2 for the arguments
} hn_op_info;

/// The row of an operator; static, never NULL.
const hn_op_info *hn_op_get_info(hn_op op);
/// The typed function of this name (hypot and recip are not among them), or HN_OP_COUNT.
hn_op hn_op_find(const char *name);

#endif
