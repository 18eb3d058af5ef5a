// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/lanes.h"

#include "expr/lanes_forms.h"
#include "expr/tape_code.h"

#include <math.h>
#include <string.h>

enum { VECTORS = HN_LANES / HN_LANE_WIDTH };

/// One slot of the workspace.
typedef struct lanes {
    hn_lane_vector part[VECTORS];
} lanes;

size_t hn_lanes_work_size(const hn_tape *tape) {
    return (size_t)tape->info.slots * HN_LANES;
}

void hn_lanes_prepare(const hn_tape *tape, double *work) {
    memset(work, 0, hn_lanes_work_size(tape) * sizeof *work);
    for (int i = 0; i < tape->n_constants; i++) {
        for (int k = 0; k < HN_LANES; k++) {
            work[(size_t)(tape->info.n_inputs + i) * HN_LANES + (size_t)k] = tape->constants[i];
        }
    }
}

// ---- instructions that are not one expression: lane by lane ----

static double *block_of(double *work, int slot) {
    return work + (size_t)slot * HN_LANES;
}

static void run_function(const hn_tape_instruction *i, double *work) {
    const double *a = block_of(work, i->v[1]), *b = block_of(work, i->v[2]);
    double *out = block_of(work, i->v[0]);
    const hn_op_value value = i->code >= TAPE_CALL1 ? hn_op_get_info((hn_op)i->v[6])->value : NULL;
    for (int k = 0; k < HN_LANES; k++) {
        const double x[2] = {a[k], i->code == TAPE_CALL2 ? b[k] : 0};
        out[k] = value ? value(x) : i->code == TAPE_SIN ? sin(x[0]) : cos(x[0]);
    }
}

static void run_other(const hn_tape_instruction *i, hn_lanes_sincos sincos, double *work) {
    if (i->code == TAPE_SINCOS) {
        sincos(HN_LANES, block_of(work, i->v[1]), block_of(work, i->v[0]), block_of(work, i->v[2]));
    } else {
        run_function(i, work);
    }
}

// ---- arithmetic: the table of instructions on vectors ----

// operands of the instruction at `i`, vector number k
#define block(n) (w[i->v[n]].part)
#define a (block(1)[k])
#define b (block(2)[k])
#define c (block(3)[k])
#define d (block(4)[k])
#define e (block(5)[k])
#define f (block(6)[k])
#define sqrt(x)                                      \
    __extension__({                                  \
        hn_lane_vector root = (x);                   \
        for (int at = 0; at < HN_LANE_WIDTH; at++) { \
            root[at] = __builtin_sqrt(root[at]);     \
        }                                            \
        root;                                        \
    })

#ifdef __clang__
#define UNROLLED _Pragma("clang loop unroll(full)")
#else
#define UNROLLED _Pragma("GCC unroll 4")
#endif

HN_LANES_BODY run_body(const hn_tape *tape, hn_lanes_sincos sincos, double *work) {
    lanes *const w = (lanes *)(void *)work;
    for (const hn_tape_instruction *i = tape->code; i->code != TAPE_END; i++) {
        switch (i->code) {
#define RUN(code, key, n, expression)                \
    case code:                                       \
        UNROLLED for (int k = 0; k < VECTORS; k++) { \
            block(0)[k] = (expression);              \
        }                                            \
        break;
#define TAPE_ARITHMETIC(X) HN_TAPE_OPS_BUT_END(X)
            TAPE_ARITHMETIC(RUN)
        default:
            run_other(i, sincos, work);
        }
    }
}

HN_LANES_FORMS(run, (const hn_tape *tape, hn_lanes_sincos sincos, double *work),
               (tape, sincos, work))

void hn_lanes_run(const hn_tape *tape, hn_lanes_set set, double *work) {
    run_forms[set](tape, hn_lanes_sincos_get(set), work);
}

// ---- one bit for each lane ----

/// Returns whether all lanes are good, as they mostly are.
static bool are_all_good(const hn_lane_half_bits *below, const hn_lane_half *zero) {
    hn_lane_half_bits negative = below[0];
    hn_lane_half sum = zero[0];
    for (int k = 1; k < 2 * VECTORS; k++) {
        negative &= below[k];
        sum += zero[k];
    }
    return (negative[0] & negative[1] & negative[2] & negative[3]) < 0 &&
           sum[0] + sum[1] + sum[2] + sum[3] == 0;
}

hn_lane_bits hn_lanes_bits(const hn_lane_half_bits *below, const hn_lane_half *zero) {
    if (are_all_good(below, zero)) {
        return (hn_lane_bits)-1;
    }
    const long long *sign = (const long long *)(const void *)below;
    const double *none = (const double *)(const void *)zero;
    hn_lane_bits bits = 0;
    for (int k = 0; k < HN_LANES; k++) {
        bits |= (hn_lane_bits)((sign[k] < 0) & (none[k] == 0)) << k;
    }
    return bits;
}
