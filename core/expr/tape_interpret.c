// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // sincos
#include "expr/tape_interpret.h"

#include <math.h>

// operands of the instruction at `i`
#define a (w[i->v[1]])
#define b (w[i->v[2]])
#define c (w[i->v[3]])
#define d (w[i->v[4]])
#define e (w[i->v[5]])
#define f (w[i->v[6]])

/// One jump per instruction, from the end of the one before, so that the processor learns each
/// one's successor.
void hn_tape_interpret(const hn_tape *tape, double *w) {
    const hn_tape_instruction *i = tape->code;
#define LABEL(code, key, n, expression) &&run_##code,
#define NEXT \
    i++;     \
    __extension__({ goto *label[i->code]; })
#define RUN(code, key, n, expression)       \
    run_##code : w[i->v[0]] = (expression); \
    NEXT;
#define TAPE_ARITHMETIC(X) HN_TAPE_OPS_BUT_END(X)

    // one label per instruction, in the order of the codes
    __extension__ static const void *const label[TAPE_CODES] = {
        HN_TAPE_OPS(LABEL) && run_sincos, &&run_sin, &&run_cos, &&run_call1, &&run_call2};
    __extension__({ goto *label[i->code]; });

    TAPE_ARITHMETIC(RUN)
run_sincos:
    sincos(a, &w[i->v[0]], &w[i->v[2]]);
    NEXT;
run_sin:
    w[i->v[0]] = sin(a);
    NEXT;
run_cos:
    w[i->v[0]] = cos(a);
    NEXT;
run_call1 : {
    const double x = a;
    w[i->v[0]] = hn_op_get_info((hn_op)i->v[6])->value(&x);
    NEXT;
}
run_call2 : {
    const double x[2] = {a, b};
    w[i->v[0]] = hn_op_get_info((hn_op)i->v[6])->value(x);
    NEXT;
}
run_TAPE_END:
    return;
#undef LABEL
#undef NEXT
#undef RUN
#undef TAPE_ARITHMETIC
}

#undef a
#undef b
#undef c
#undef d
#undef e
#undef f
