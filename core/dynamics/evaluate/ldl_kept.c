// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/ldl_kept.h"

#include "dynamics/compile/system_impl.h"
#include "dynamics/evaluate/accel.h"
#include "expr/construct.h"

static void take_diagonal(const hn_system *sys, hn_entries *W) {
    for (int i = 0; i < sys->nv; i++) {
        hn_ex mass = hn_num(1);
        for (int k = 0; k < sys->M.n; k++) {
            const hn_entry *m = &sys->M.at[k];
            mass = m->row == i && m->col == i ? m->e : mass;
        }
        hn_entries_add(W, i, i, mass);
    }
}

static hn_status build(const hn_system *sys, hn_factor_weight weight, hn_ldl *out) {
    hn_entries diagonal = {0};
    const hn_entries *W = weight == HN_FACTOR_MASS ? &sys->M : NULL;
    if (weight == HN_FACTOR_DIAGONAL) {
        take_diagonal(sys, &diagonal);
        W = &diagonal;
    }
    const hn_ldl_input in = {sys->nv, sys->nc, W, &sys->J, HN_ACCEL_PAIRS};
    const hn_status status =
        diagonal.failed ? HN_ERR_MEMORY : hn_ldl_build(sys->g, &in, sys->arena, out);
    hn_entries_reset(&diagonal);
    return status;
}

hn_status hn_ldl_kept_get(const hn_system *sys, hn_factor_weight weight, const hn_ldl **out) {
    struct hn_ldl **kept = &sys->ldls[weight];
    if (!*kept) {
        hn_ldl *made = hn_arena_get(sys->arena, sizeof *made);
        HN_TRY(made ? build(sys, weight, made) : HN_ERR_MEMORY);
        *kept = made;
    }
    *out = *kept;
    return HN_OK;
}
