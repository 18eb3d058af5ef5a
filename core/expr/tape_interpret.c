// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // sincos
#include "expr/tape_interpret.h"

#include "base/clock.h"

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>

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

/// An operator of the table with one or two arguments.
static double call(const hn_tape_instruction *i, const double *w) {
    const double x[2] = {a, i->code == TAPE_CALL2 ? b : 0};
    return hn_op_get_info((hn_op)i->v[6])->value(x);
}

/// The instructions that are more than one expression.
#define TAPE_FUNCTIONS(X)                               \
    X(TAPE_SINCOS, sincos(a, &w[i->v[0]], &w[i->v[2]])) \
    X(TAPE_SIN, w[i->v[0]] = sin(a))                    \
    X(TAPE_COS, w[i->v[0]] = cos(a))                    \
    X(TAPE_CALL1, w[i->v[0]] = call(i, w))              \
    X(TAPE_CALL2, w[i->v[0]] = call(i, w))
#define TAPE_ARITHMETIC(X) HN_TAPE_OPS_BUT_END(X)

/// Finds the angles, if four can be found at once; returns the instruction to go on with.
static const hn_tape_instruction *begin(const hn_tape *tape, double *w) {
    return tape->four ? find_angles(tape, w) : tape->code;
}

/// One jump for each instruction, from the end of the one before, so that the processor learns each
/// one's successor. The empty statement keeps the compiler from sharing a jump among instructions
/// that end alike.
static void run_by_jumps(const hn_tape *tape, double *w) {
    const hn_tape_instruction *i = begin(tape, w);
    const void *next;
#define LABEL(code, key, n, expression) &&run_##code,
#define LABEL_OF(code, statement) &&run_##code,
#define NEXT(number)                                 \
    i++;                                             \
    next = label[i->code];                           \
    __asm__ volatile("" : "+r"(next) : "i"(number)); \
    __extension__({ goto *next; });
#define RUN(code, key, n, expression)       \
    run_##code : w[i->v[0]] = (expression); \
    NEXT(code)
#define CALL(code, statement) \
    run_##code : statement;   \
    NEXT(code)

    // one label per instruction, in the order of the codes
    __extension__ static const void *const label[TAPE_CODES] = {HN_TAPE_OPS(LABEL)
                                                                    TAPE_FUNCTIONS(LABEL_OF)};
    __extension__({ goto *label[i->code]; });

    TAPE_ARITHMETIC(RUN)
    TAPE_FUNCTIONS(CALL)
run_TAPE_END:
    return;
#undef LABEL
#undef LABEL_OF
#undef NEXT
#undef RUN
#undef CALL
}

static void run_by_switch(const hn_tape *tape, double *w) {
    for (const hn_tape_instruction *i = begin(tape, w);; i++) {
#define RUN(code, key, n, expression) \
    case code:                        \
        w[i->v[0]] = (expression);    \
        break;
#define CALL(code, statement) \
    case code:                \
        statement;            \
        break;
        switch (i->code) {
            TAPE_ARITHMETIC(RUN)
            TAPE_FUNCTIONS(CALL)
        default: // TAPE_END
            return;
        }
#undef RUN
#undef CALL
    }
}

#undef TAPE_FUNCTIONS
#undef TAPE_ARITHMETIC
#undef a
#undef b
#undef c
#undef d
#undef e
#undef f

// ---- the choice ----

typedef void (*interpreter)(const hn_tape *tape, double *w);
static const interpreter forms[HN_TAPE_DISPATCHES] = {run_by_jumps, run_by_switch};

// a millisecond: so many rounds of either form, each of so many instructions
enum { ROUNDS = 32, ROUND = 10000 };
// of the time of the jumps: nearer than this the difference is noise
static const double QUICKER = 0.95;

/// Runs a tape by both forms in turn; its values stay as they are. Returns the quicker form, by
/// the least time of each: whatever disturbs a round makes it longer.
static hn_tape_dispatch compare(const hn_tape *tape, double *w) {
    const int runs = 1 + ROUND / tape->info.instructions;
    double least[HN_TAPE_DISPATCHES] = {HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < ROUNDS; k++) {
        for (int form = 0; form < HN_TAPE_DISPATCHES; form++) {
            const double start = hn_clock_ticks();
            for (int i = 0; i < runs; i++) {
                forms[form](tape, w);
            }
            least[form] = fmin(least[form], hn_clock_ticks() - start);
        }
    }
    return least[HN_TAPE_SWITCH] < QUICKER * least[HN_TAPE_JUMPS] ? HN_TAPE_SWITCH : HN_TAPE_JUMPS;
}

static void run_first(const hn_tape *tape, double *w);

/// State of the process, as its processor is one: the form that serves, and the progress of the
/// comparison.
static _Atomic(interpreter) serving = run_first;
static atomic_int seen; // instructions so far; loses some where threads count at once
static atomic_flag is_taken = ATOMIC_FLAG_INIT;

/// Counts until the forms are to be compared; one thread does it.
static void run_first(const hn_tape *tape, double *w) {
    run_by_jumps(tape, w);
    const int n = tape->info.instructions + atomic_load_explicit(&seen, memory_order_relaxed);
    if (n < HN_TAPE_COMPARED_AFTER) {
        atomic_store_explicit(&seen, n, memory_order_relaxed);
    } else if (tape->info.instructions >= HN_TAPE_COMPARED_LENGTH &&
               !atomic_flag_test_and_set(&is_taken)) {
        atomic_store(&serving, forms[compare(tape, w)]);
    }
}

void hn_tape_interpret(const hn_tape *tape, double *w) {
    atomic_load_explicit(&serving, memory_order_relaxed)(tape, w);
}

void hn_tape_interpret_by(hn_tape_dispatch form, const hn_tape *tape, double *w) {
    forms[form](tape, w);
}

bool hn_tape_is_compared(hn_tape_dispatch *serves) {
    const interpreter now = atomic_load(&serving);
    *serves = now == run_by_switch ? HN_TAPE_SWITCH : HN_TAPE_JUMPS;
    return now != run_first;
}
