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

/// Runs the instructions that find sines and cosines of inputs, four at once, the last ones filled
/// up with one of them; returns the instruction behind them.
static const hn_tape_instruction *find_angles(const hn_tape *tape, double *w) {
    const hn_tape_instruction *i = tape->code;
    for (int32_t left = tape->n_angles; left > 0; left -= 4, i += 4) {
        const hn_tape_instruction *const second = left > 1 ? i + 1 : i,
                                         *const third = left > 2 ? i + 2 : i,
                                         *const fourth = left > 3 ? i + 3 : i;
        double sine[4], cosine[4];
        tape->four(w[i->v[1]], w[second->v[1]], w[third->v[1]], w[fourth->v[1]], sine, cosine);
        w[fourth->v[0]] = sine[3];
        w[fourth->v[2]] = cosine[3];
        w[third->v[0]] = sine[2];
        w[third->v[2]] = cosine[2];
        w[second->v[0]] = sine[1];
        w[second->v[2]] = cosine[1];
        w[i->v[0]] = sine[0];
        w[i->v[2]] = cosine[0];
    }
    return tape->code + tape->n_angles;
}

/// One jump per instruction, from the end of the one before, so that the processor learns each
/// one's successor.
void hn_tape_interpret(const hn_tape *tape, double *w) {
    const hn_tape_instruction *i = tape->four ? find_angles(tape, w) : tape->code;
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
