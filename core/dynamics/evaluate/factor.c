// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/factor.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/inputs.h"
#include "dynamics/evaluate/ldl_kept.h"
#include "dynamics/evaluate/row_groups.h"
#include "expr/construct.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

struct hn_factor {
    hn_inputs in;
    const hn_ldl *ldl; ///< the pattern; borrowed from the system
    double (*L)[2];    ///< values
    double (*Dinv)[3];
    double **target;     ///< where tape output k goes
    int n_values, n_out; ///< outputs that are values; then pivot and reference of each guard
    hn_row_groups rows;
    double row_ratio;
    bool has_row_ratio; ///< of the last update; found when it is asked for
    double *x;          ///< right-hand side and solution
    hn_factor_info info;
    int ready;
};

/// A value that is a number is set once, the others become outputs of the tape.
static void put(hn_factor *f, hn_ex *outputs, double *place, hn_ex e) {
    if (!hn_is_number(e, place)) {
        f->target[f->n_values] = place;
        outputs[f->n_values++] = e;
    }
}

static void list_values(hn_factor *f, hn_ex *outputs) {
    const hn_ldl *ldl = f->ldl;

    // values: the inverse pivots and the columns of L
    for (int b = 0; b < ldl->n_blocks; b++) {
        int two = ldl->block[b + 1] - ldl->block[b] == 2;
        for (int k = 0; k < (two ? 3 : 1); k++) {
            put(f, outputs, &f->Dinv[b][k], ldl->Dinv[b][k]);
        }
        for (int k = ldl->column[b]; k < ldl->column[b + 1]; k++) {
            for (int j = 0; j <= two; j++) {
                put(f, outputs, &f->L[k][j], ldl->L[k][j]);
            }
        }
        // forward and back: a product and a sum per entry of L; the pivot block
        f->info.solve_ops += 4 * (1 + two) * (ldl->column[b + 1] - ldl->column[b]) + (two ? 6 : 1);
    }

    // then the pivots and references of the guards, and the rows' lengths
    f->n_out = f->n_values;
    for (int k = 0; k < ldl->n_guards; k++) {
        outputs[f->n_out++] = ldl->guard[k][0];
        outputs[f->n_out++] = ldl->guard[k][1];
    }
    memcpy(outputs + f->n_out, ldl->row_ref, (size_t)ldl->nc * sizeof *outputs);
}

static hn_status build(hn_factor *f, const hn_system *sys, hn_factor_weight weight,
                       hn_arena *arena) {
    HN_TRY(hn_ldl_kept_get(sys, weight, &f->ldl));
    f->info.available = f->ldl->available;
    if (!f->ldl->available) {
        return HN_OK;
    }

    // room for the values
    const hn_ldl *ldl = f->ldl;
    size_t n_cap = 2 * (size_t)ldl->nnz + 3 * (size_t)ldl->n_blocks;
    f->info.n_blocks = ldl->n_blocks;
    f->info.nnz = ldl->nnz;
    f->L = hn_arena_get(arena, (size_t)ldl->nnz * sizeof *f->L);
    f->Dinv = hn_arena_get(arena, (size_t)ldl->n_blocks * sizeof *f->Dinv);
    f->target = hn_arena_get(arena, n_cap * sizeof *f->target);
    f->x = hn_arena_doubles(arena, (size_t)ldl->n);

    // the tape that computes them
    hn_ex *outputs =
        malloc((n_cap + 2 * (size_t)ldl->n_guards + (size_t)ldl->nc + 1) * sizeof *outputs);
    if (!outputs || hn_arena_failed(arena)) {
        free(outputs);
        return HN_ERR_MEMORY;
    }
    list_values(f, outputs);
    hn_status status = hn_inputs_compile(sys, outputs, f->n_out + ldl->nc, arena, &f->in);
    free(outputs);

    HN_THEN(status, hn_row_groups_init(sys, arena, &f->rows));
    if (status == HN_OK) {
        f->info.update_ops = hn_tape_get_info(f->in.tape).ops;
    }
    return status;
}

hn_status hn_factor_create(const hn_system *sys, hn_factor_weight weight, hn_arena *arena,
                           hn_factor **out) {
    HN_ASSERT(sys && arena && out);
    hn_factor *f = hn_arena_get(arena, sizeof *f);
    *out = NULL;
    if (!f) {
        return HN_ERR_MEMORY;
    }
    hn_status status = build(f, sys, weight, arena);
    if (status != HN_OK) {
        hn_factor_free(f);
        return status;
    }
    *out = f;
    return HN_OK;
}

void hn_factor_free(hn_factor *f) {
    if (f) {
        hn_inputs_free(&f->in);
    }
}

hn_factor_info hn_factor_get_info(const hn_factor *f) {
    return f->info;
}

/// Returns whether every pivot is so far above its guard that roundings of the comparison do not
/// matter.
static bool is_sure(const hn_factor *f) {
    const double *x = f->in.x, sure = 2 * HN_PIVOT_GUARD;
    const uint16_t *slots = f->in.slots;
    bool all = true;
    for (int k = f->n_values; k < f->n_out; k += 2) { // a NaN is not above anything
        all &= fabs(x[slots[k]]) > sure * fabs(x[slots[k + 1]]);
    }
    return all;
}

static double find_worst_pivot(const hn_factor *f) {
    const double *x = f->in.x;
    const uint16_t *slots = f->in.slots;
    double worst = 1;
    for (int k = f->n_values; k < f->n_out; k += 2) {
        double ratio = fabs(x[slots[k]]) / fabs(x[slots[k + 1]]);
        worst = ratio >= worst ? worst : ratio >= 0 ? ratio : 0;
    }
    return worst;
}

/// Puts the tape's values in their places; false where one is not finite.
static bool scatter(hn_factor *f) {
    const double *x = f->in.x;
    const uint16_t *slots = f->in.slots;
    bool finite = true;
    for (int k = 0; k < f->n_values; k++) {
        *f->target[k] = x[slots[k]];
        finite &= fabs(x[slots[k]]) <= DBL_MAX;
    }
    return finite;
}

hn_status hn_factor_update(hn_factor *f, double t, const double *q, double *pivot_ratio) {
    f->ready = 0;
    f->row_ratio = 1;
    f->has_row_ratio = true;

    // no static order exists
    if (!f->info.available) {
        if (pivot_ratio) {
            *pivot_ratio = 0;
        }
        return HN_ERR_SINGULAR;
    }

    // values at this pose
    hn_inputs_set(&f->in, t, q, NULL, 0, 0);
    for (int i = 0; i < f->in.n; i++) {
        if (!isfinite(f->in.x[i])) {
            return HN_ERR_DIVERGED;
        }
    }
    hn_tape_run(f->in.tape, f->in.x);

    // the worst pivot against its reference, 0 where a value is not finite
    double worst = pivot_ratio || !is_sure(f) ? find_worst_pivot(f) : 1;
    worst = scatter(f) ? worst : 0;
    if (pivot_ratio) {
        *pivot_ratio = worst;
    }
    f->has_row_ratio = false;
    f->ready = worst >= HN_PIVOT_GUARD;
    return f->ready ? HN_OK : HN_ERR_SINGULAR;
}

double hn_factor_row_ratio(hn_factor *f) {
    if (f->info.available && !f->has_row_ratio) {
        f->row_ratio = hn_row_groups_ratio(&f->rows, f->in.x, f->in.slots + f->n_out);
        f->has_row_ratio = true;
    }
    return f->info.available ? f->row_ratio : 1;
}

static void forward(const hn_factor *f, double *x) {
    const hn_ldl *ldl = f->ldl;
    for (int b = 0; b < ldl->n_blocks; b++) {
        const int *at = &ldl->unknown[ldl->block[b]];
        int two = ldl->block[b + 1] - ldl->block[b] == 2;
        double x1 = x[at[0]], x2 = two ? x[at[1]] : 0;
        for (int k = ldl->column[b]; k < ldl->column[b + 1]; k++) {
            x[ldl->row[k]] -= f->L[k][0] * x1 + f->L[k][1] * x2;
        }
    }
}

static void back(const hn_factor *f, double *x) {
    const hn_ldl *ldl = f->ldl;
    for (int b = ldl->n_blocks - 1; b >= 0; b--) {
        const int *at = &ldl->unknown[ldl->block[b]];
        const double *D = f->Dinv[b];
        int two = ldl->block[b + 1] - ldl->block[b] == 2;
        double y1 = x[at[0]], y2 = two ? x[at[1]] : 0;
        double z1 = D[0] * y1 + D[1] * y2, z2 = D[1] * y1 + D[2] * y2;
        for (int k = ldl->column[b]; k < ldl->column[b + 1]; k++) {
            z1 -= f->L[k][0] * x[ldl->row[k]];
            z2 -= f->L[k][1] * x[ldl->row[k]];
        }
        x[at[0]] = z1;
        if (two) {
            x[at[1]] = z2;
        }
    }
}

void hn_factor_solve(hn_factor *f, const double *r1, const double *r2, double *x, double *y) {
    HN_ASSERT(f->ready);
    size_t nv = (size_t)f->ldl->nv, nc = (size_t)f->ldl->nc;
    memset(f->x, 0, (nv + nc) * sizeof *f->x);
    if (r1) {
        memcpy(f->x, r1, nv * sizeof *r1);
    }
    if (r2) {
        memcpy(f->x + nv, r2, nc * sizeof *r2);
    }
    forward(f, f->x);
    back(f, f->x);
    memcpy(x, f->x, nv * sizeof *x);
    for (size_t i = 0; y && i < nc; i++) {
        y[i] = -f->x[nv + i];
    }
}
