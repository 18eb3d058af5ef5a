// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/rk_lanes.h"

#include "expr/lanes_forms.h"

#include <limits.h>
#include <string.h>

enum { VECTORS = HN_LANES / HN_LANE_WIDTH, HALVES = 2 * VECTORS };

hn_status hn_rk_lanes_create(const hn_tableau *tab, const hn_accel *accel, hn_lanes_set set,
                             hn_arena *arena, hn_rk_lanes *out) {
    HN_ASSERT(!tab->fsal && tab->extra == 0);
    *out = (hn_rk_lanes){.tab = tab};
    HN_TRY(hn_accel_lanes_create(accel, set, arena, &out->accel));
    if (out->accel.nq != out->accel.nv) {
        return HN_ERR_UNSUPPORTED;
    }

    // states, slopes and what every lane has of its own
    out->n = 2 * out->accel.nv;
    const size_t block = (size_t)out->n * HN_LANES;
    out->y = hn_arena_doubles(arena, block);
    out->y_new = hn_arena_doubles(arena, block);
    out->increment = hn_arena_doubles(arena, block);
    out->k = hn_arena_doubles(arena, block * (size_t)tab->stages);
    out->h = hn_arena_doubles(arena, HN_LANES);
    out->t = hn_arena_doubles(arena, HN_LANES);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

void hn_rk_lanes_free(hn_rk_lanes *rk) {
    hn_accel_lanes_free(&rk->accel);
}

/// out = base + h sum_i w_i k_i, or where `base` is NULL 0 + h sum_i w_i k_i; eq. (1) of tableau.h.
HN_LANES_BODY combine_body(const hn_rk_lanes *rk, const double *weight, int stages,
                           const double *base, double *out) {
    const hn_lane_vector *const h = (const hn_lane_vector *)(const void *)rk->h;
    const size_t stride = (size_t)rk->n * VECTORS;
    for (size_t j = 0; j < stride; j++) {
        hn_lane_vector sum = {0};
        for (int i = 0; i < stages; i++) {
            if (weight[i] != 0) {
                sum += weight[i] * ((const hn_lane_vector *)(const void *)rk->k)[i * stride + j];
            }
        }
        const hn_lane_vector from =
            base ? ((const hn_lane_vector *)(const void *)base)[j] : (hn_lane_vector){0};
        ((hn_lane_vector *)(void *)out)[j] = from + h[j % VECTORS] * sum;
    }
}

HN_LANES_FORMS(combine,
               (const hn_rk_lanes *rk, const double *weight, int stages, const double *base,
                double *out),
               (rk, weight, stages, base, out))

/// Slopes of the states that stand in the inputs of the accelerations, at times t + c h.
static hn_lane_bits eval_stage(hn_rk_lanes *rk, int stage) {
    hn_accel_lanes *a = &rk->accel;
    const size_t half = (size_t)a->nv * HN_LANES;
    double *k = rk->k + (size_t)stage * 2 * half;
    const double c = rk->tab->c[stage];
    for (int lane = 0; lane < HN_LANES; lane++) {
        a->t[lane] = stage == 0 ? rk->t[lane] : rk->t[lane] + c * rk->h[lane];
    }
    memcpy(k, a->v, half * sizeof *k);
    const hn_lane_bits sure = hn_accel_lanes_eval(a);
    for (int i = 0; i < a->nv; i++) {
        memcpy(k + half + (size_t)i * HN_LANES, hn_accel_lanes_a(a, i), HN_LANES * sizeof *k);
    }
    return sure;
}

/// y_new = y + increment, and in `below` the sign of numbers that are negative where every entry is
/// below the bound; `zero` is 0 where every entry is finite.
HN_LANES_BODY add_body(const hn_rk_lanes *rk, double bound, hn_lane_half_bits *below,
                       hn_lane_half *zero) {
    const hn_lane_half_bits size = ~((hn_lane_half_bits){0} + LLONG_MIN);
    for (size_t k = 0; k < HALVES; k++) {
        hn_lane_half_bits less = (hn_lane_half_bits){0} - 1;
        hn_lane_half nothing = {0};
        for (size_t j = k; j < (size_t)rk->n * HALVES; j += HALVES) {
            const hn_lane_half y = ((const hn_lane_half *)(const void *)rk->y)[j] +
                                   ((const hn_lane_half *)(const void *)rk->increment)[j];
            ((hn_lane_half *)(void *)rk->y_new)[j] = y;
            less &= (hn_lane_half_bits)((hn_lane_half)((hn_lane_half_bits)y & size) - bound);
            nothing += y * 0;
        }
        below[k] = less;
        zero[k] = nothing;
    }
}

HN_LANES_FORMS(add,
               (const hn_rk_lanes *rk, double bound, hn_lane_half_bits *below, hn_lane_half *zero),
               (rk, bound, below, zero))

static hn_lane_bits add_increment(hn_rk_lanes *rk, double bound) {
    hn_lane_half_bits below[HALVES];
    hn_lane_half zero[HALVES];
    add_forms[rk->accel.code.set](rk, bound, below, zero);
    return hn_lanes_bits(below, zero);
}

hn_lane_bits hn_rk_lanes_step(hn_rk_lanes *rk, double bound) {
    const hn_tableau *tab = rk->tab;
    hn_lane_bits sure;
    memcpy(rk->accel.q, rk->y, (size_t)rk->n * HN_LANES * sizeof *rk->y);
    sure = eval_stage(rk, 0);
    for (int i = 1; i < tab->stages; i++) {
        combine_forms[rk->accel.code.set](rk, tab->A + (size_t)i * (size_t)tab->stages, i, rk->y,
                                          rk->accel.q);
        sure &= eval_stage(rk, i);
    }
    combine_forms[rk->accel.code.set](rk, tab->b, tab->stages, NULL, rk->increment);
    return sure & add_increment(rk, bound);
}

void hn_rk_lanes_accept(hn_rk_lanes *rk) {
    double *const spent = rk->y;
    rk->y = rk->y_new;
    rk->y_new = spent;
}
