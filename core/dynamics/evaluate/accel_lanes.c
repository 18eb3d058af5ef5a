// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel_lanes.h"

#include "dynamics/evaluate/accel_tape.h"
#include "expr/lanes_forms.h"

#include <float.h>
#include <limits.h>
#include <math.h>

enum { HALVES = 2 * HN_LANES / HN_LANE_WIDTH };

bool hn_accel_has_lanes(const hn_accel *s) {
    const hn_inputs *in;
    return hn_accel_get_tape(s, &in) != NULL;
}

hn_status hn_accel_lanes_create(const hn_accel *s, hn_lanes_set set, hn_arena *arena,
                                hn_accel_lanes *out) {
    const hn_inputs *in;
    const hn_accel_tape *tape = hn_accel_get_tape(s, &in);
    if (!tape) {
        return HN_ERR_UNSUPPORTED;
    }
    double *work = hn_arena_doubles(arena, hn_lanes_work_size(in->tape));
    if (!work) {
        return HN_ERR_MEMORY;
    }

    // parameters that stayed symbols keep the values they have
    hn_lanes_prepare(in->tape, work);
    for (int i = in->nq + in->nv; i < in->n; i++) {
        for (int k = 0; k < HN_LANES; k++) {
            work[HN_LANES * (size_t)i + (size_t)k] = in->x[i];
        }
    }
    double *const t = work + HN_LANES * (size_t)(in->nq + in->nv);
    *out = (hn_accel_lanes){.layout = tape,
                            .nq = in->nq,
                            .nv = in->nv,
                            .slots = in->slots,
                            .work = work,
                            .q = work,
                            .v = work + HN_LANES * (size_t)in->nq,
                            .t = t,
                            .alpha = t + HN_LANES,
                            .beta = t + 2 * HN_LANES};
    hn_lanes_tape_init(&out->code, in->tape, set);
    return HN_OK;
}

void hn_accel_lanes_free(hn_accel_lanes *l) {
    hn_lanes_tape_reset(&l->code);
}

/// The result of a judgement of each lane: `below` has the sign of a sum that is negative where
/// every comparison holds, `zero` is 0 where every number is finite.
typedef struct verdicts {
    hn_lane_half_bits below[HALVES];
    hn_lane_half zero[HALVES];
} verdicts;

/// The checks of hn_accel_tape_solve(), or stricter ones, on all lanes: rows are compared with
/// the sum in place of the largest. Differences and signs, for compilers split comparisons of
/// vectors that the processor does not have into single ones.
HN_LANES_BODY judge_body(const hn_accel_lanes *l, verdicts *out) {
    const hn_accel_tape *at = l->layout;
    const uint16_t *guard = l->slots + at->n_answer, *rows = guard + 2 * at->n_guards;
    const int n_rows = at->n_out - at->n_answer - 2 * at->n_guards;
    const hn_lane_half_bits size = ~((hn_lane_half_bits){0} + LLONG_MIN); // all bits but the sign
    const hn_lane_half *const w = (const hn_lane_half *)(const void *)l->work;
#define VALUE(slot) (w[HALVES * (size_t)(slot) + k])
#define SIZE(slot) ((hn_lane_half)((hn_lane_half_bits)VALUE(slot) & size))

    for (size_t k = 0; k < HALVES; k++) {
        hn_lane_half_bits below = (hn_lane_half_bits){0} - 1;
        hn_lane_half zero = {0}, rows_sum = {0};
        for (int i = 0; i < at->n_answer; i++) {
            zero += VALUE(l->slots[i]) * 0;
        }
        for (int i = 0; i < at->n_guards; i++) {
            const hn_lane_half pivot = SIZE(guard[2 * i]), reference = SIZE(guard[2 * i + 1]);
            const hn_lane_half less = HN_ACCEL_SURE_PIVOT * reference - pivot;
            below &= (hn_lane_half_bits)less;
            zero += less * 0;
        }

        // each row beside all of its system
        for (int i = 0; i < n_rows; i++) {
            rows_sum += SIZE(rows[i]);
        }
        zero += rows_sum * 0;
        for (int i = 0; i < n_rows; i++) {
            below &= (hn_lane_half_bits)(HN_ACCEL_SURE_ROW * rows_sum - SIZE(rows[i]));
        }
        out->below[k] = below;
        out->zero[k] = zero;
    }
#undef VALUE
#undef SIZE
}

HN_LANES_FORMS(judge, (const hn_accel_lanes *l, verdicts *out), (l, out))

hn_lane_bits hn_accel_lanes_eval(hn_accel_lanes *l) {
    verdicts found;
    hn_lanes_tape_run(&l->code, l->work);
    judge_forms[l->code.set](l, &found);
    return hn_lanes_bits(found.below, found.zero);
}
