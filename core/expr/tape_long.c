// SPDX-License-Identifier: GPL-3.0-or-later
// The tape in extended precision: a plain loop, for what is computed once and kept.
#define _GNU_SOURCE // sincosl

#include "expr/tape_long.h"

#include "expr/tape_code.h"

#include <string.h>
#include <tgmath.h> // sqrt of the table of instructions is that of its operand's type

void hn_tape_prepare_long(const hn_tape *tape, long double *work) {
    memset(work, 0, (size_t)tape->info.slots * sizeof *work);
    for (int i = 0; i < tape->n_constants; i++) {
        work[tape->info.n_inputs + i] = (long double)tape->constants[i];
    }
}

// operands of the instruction at `i`
#define a (w[i->v[1]])
#define b (w[i->v[2]])
#define c (w[i->v[3]])
#define d (w[i->v[4]])
#define e (w[i->v[5]])
#define f (w[i->v[6]])

/// Those that are not one expression.
static void call(const hn_tape_instruction *i, long double *w) {
    switch (i->code) {
    case TAPE_SINCOS: {
        const long double angle = a;
        sincosl(angle, &w[i->v[0]], &w[i->v[2]]);
        break;
    }
    case TAPE_SIN:
        w[i->v[0]] = sinl(a);
        break;
    case TAPE_COS:
        w[i->v[0]] = cosl(a);
        break;
    default: {
        const int two = i->code == TAPE_CALL2;
        const long double x[2] = {a, two ? b : 0.0L};
        w[i->v[0]] = hn_op_get_info((hn_op)i->v[6])->value_long(x);
    }
    }
}

void hn_tape_run_long(const hn_tape *tape, long double *w) {
    for (const hn_tape_instruction *i = tape->code; i->code != TAPE_END; i++) {
        switch (i->code) {
#define RUN(code, key, n, expression) \
    case code:                        \
        w[i->v[0]] = (expression);    \
        break;
#define TAPE_ARITHMETIC(X) HN_TAPE_OPS_BUT_END(X)
            TAPE_ARITHMETIC(RUN)
        default:
            call(i, w);
        }
    }
}
