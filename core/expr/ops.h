#ifndef HN_EXPR_OPS_H
#define HN_EXPR_OPS_H
// The one table of operators: name as typed, arity, cost, value, derivative, text and LaTeX form, C form. The
// parser, the folder, differentiation, the printers and the tape all read it.

/// code, name as typed, arity
#define HN_OP_LIST(X)                                                                              \
    X(HN_OP_ONE, "1", 0)                                                                           \
    X(HN_OP_SYMBOL, "symbol", 0)                                                                   \
    X(HN_OP_SUM, "+", -1)                                                                          \
    X(HN_OP_MUL, "*", 2)                                                                           \
    X(HN_OP_RECIP, "recip", 1)                                                                     \
    X(HN_OP_SQRT, "sqrt", 1)                                                                       \
    X(HN_OP_SIN, "sin", 1)                                                                         \
    X(HN_OP_COS, "cos", 1)                                                                         \
    X(HN_OP_TAN, "tan", 1)                                                                         \
    X(HN_OP_ASIN, "asin", 1)                                                                       \
    X(HN_OP_ACOS, "acos", 1)                                                                       \
    X(HN_OP_ATAN, "atan", 1)                                                                       \
    X(HN_OP_ATAN2, "atan2", 2)                                                                     \
    X(HN_OP_SINH, "sinh", 1)                                                                       \
    X(HN_OP_COSH, "cosh", 1)                                                                       \
    X(HN_OP_TANH, "tanh", 1)                                                                       \
    X(HN_OP_EXP, "exp", 1)                                                                         \
    X(HN_OP_LOG, "log", 1)                                                                         \
    X(HN_OP_POW, "pow", 2)                                                                         \
    X(HN_OP_ABS, "abs", 1)                                                                         \
    X(HN_OP_SIGN, "sign", 1)                                                                       \
    X(HN_OP_STEP, "step", 1)                                                                       \
    X(HN_OP_MIN, "min", 2)                                                                         \
    X(HN_OP_MAX, "max", 2)

typedef enum hn_op {
#define HN_OP_ENUM(code, name, arity) code,
    HN_OP_LIST(HN_OP_ENUM)
#undef HN_OP_ENUM
        HN_OP_COUNT
} hn_op;

#endif
