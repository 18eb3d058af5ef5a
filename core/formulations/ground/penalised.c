// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/penalised.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// Numbers the entries of G while they are met: place (nv x nv) holds the number + 1.
static int number_entry(hn_penalised *p, int *place, int i, int j) {
    int *at = &place[(size_t)(i > j ? i : j) * (size_t)p->ode.base.nv + (size_t)(i > j ? j : i)];
    if (*at == 0) {
        p->G_row[p->n_G] = i > j ? i : j;
        p->G_col[p->n_G] = i > j ? j : i;
        *at = ++p->n_G;
    }
    return *at - 1;
}

static void list_entries(hn_penalised *p, int *place) {
    const hn_dense_ode *ode = &p->ode;
    p->n_G = p->n_pairs = 0;
    for (int i = 0; i < ode->base.nv; i++) {
        (void)number_entry(p, place, i, i);
    }
    for (int k = 0; k < ode->n_M; k++) {
        p->from_M[k] = number_entry(p, place, ode->M_row[k], ode->M_col[k]);
    }
    // entries of a row of J stand next to each other
    for (int a = 0; a < ode->n_J; a++) {
        for (int b = a; b < ode->n_J && ode->J_row[b] == ode->J_row[a]; b++) {
            int *pair = p->pair[p->n_pairs++];
            pair[0] = number_entry(p, place, ode->J_col[a], ode->J_col[b]);
            pair[1] = a;
            pair[2] = b;
        }
    }
}

static size_t count_pairs(const hn_dense_ode *ode) {
    size_t n = 0;
    for (int a = 0; a < ode->n_J; a++) {
        for (int b = a; b < ode->n_J && ode->J_row[b] == ode->J_row[a]; b++) {
            n++;
        }
    }
    return n;
}

static bool make_pattern(hn_penalised *p, hn_arena *arena) {
    const hn_dense_ode *ode = &p->ode;
    const size_t nv = (size_t)ode->base.nv, pairs = count_pairs(ode);
    const size_t cap = nv + (size_t)ode->n_M + pairs;
    p->pair = hn_arena_get(arena, (pairs + 1) * sizeof *p->pair);
    p->from_M = hn_arena_ints(arena, (size_t)ode->n_M);
    p->G_row = hn_arena_ints(arena, cap);
    p->G_col = hn_arena_ints(arena, cap);
    hn_arena *scratch = hn_arena_create(0);
    int *place = scratch ? hn_arena_ints(scratch, nv * nv) : NULL;
    if (place && !hn_arena_failed(arena)) {
        list_entries(p, place);
        p->spd = hn_sparse_spd_create(arena, ode->base.nv, p->n_G, p->G_row, p->G_col);
        p->G = hn_arena_doubles(arena, (size_t)p->n_G);
    }
    hn_arena_free(scratch);
    return p->spd && p->G;
}

hn_status hn_penalised_init(hn_penalised *p, const hn_system *sys, const double *options,
                            hn_arena *arena, hn_diag *diag) {
    HN_TRY(hn_dense_ode_init(&p->ode, sys, 1, arena, diag));
    const size_t nv = (size_t)p->ode.base.nv, nc = (size_t)p->ode.base.nc;
    p->a = options[HN_PENALISED_A];
    p->omega = options[HN_PENALISED_OMEGA];
    p->xi = options[HN_PENALISED_XI];
    p->scale = hn_arena_doubles(arena, nv);
    p->pull = hn_arena_doubles(arena, nc);
    p->work = hn_arena_doubles(arena, nc);
    p->size = hn_arena_doubles(arena, nc);
    return hn_arena_failed(arena) || !make_pattern(p, arena)
               ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory")
               : HN_OK;
}

static double median(int n, double *x) {
    for (int i = 1; i < n; i++) {
        const double value = x[i];
        int j = i;
        for (; j > 0 && x[j - 1] > value; j--) {
            x[j] = x[j - 1];
        }
        x[j] = value;
    }
    return n > 0 ? x[n / 2] : 0;
}

double hn_penalised_typical_mobility(hn_penalised *p) {
    const hn_dense_ode *ode = &p->ode;
    const size_t nv = (size_t)ode->base.nv;
    memset(p->size, 0, (size_t)ode->base.nc * sizeof *p->size);
    for (int e = 0; e < ode->n_J; e++) {
        const size_t i = (size_t)ode->J_row[e], j = (size_t)ode->J_col[e];
        const double m = ode->M[j * nv + j], entry = ode->J[i * nv + j];
        p->size[i] += m > 0 ? entry * entry / m : 0;
    }
    int n = 0;
    for (int k = 0; k < ode->base.nc; k++) {
        if (p->size[k] > 0) {
            p->size[n++] = p->size[k];
        }
    }
    return median(n, p->size);
}

static void fill(hn_penalised *p, double weight) {
    const hn_dense_ode *ode = &p->ode;
    const size_t nv = (size_t)ode->base.nv;
    memset(p->G, 0, (size_t)p->n_G * sizeof *p->G);
    for (int k = 0; k < ode->n_M; k++) {
        p->G[p->from_M[k]] = ode->M[(size_t)ode->M_row[k] * nv + (size_t)ode->M_col[k]];
    }
    for (int k = 0; k < p->n_pairs; k++) {
        const int a = p->pair[k][1], b = p->pair[k][2];
        const double *row = ode->J + (size_t)ode->J_row[a] * nv;
        p->G[p->pair[k][0]] += weight * row[ode->J_col[a]] * row[ode->J_col[b]];
    }
    p->ode.base.cost.ops += 3.0 * p->n_pairs;
}

hn_status hn_penalised_factor(hn_penalised *p, double t, double weight) {
    const int nv = p->ode.base.nv;
    fill(p, weight);

    // unit diagonal
    for (int i = 0; i < nv; i++) {
        const double g = p->G[i]; // the diagonal was numbered first
        if (!(g > 0)) {
            snprintf(p->ode.base.why, sizeof p->ode.base.why,
                     "at t = %.6g s %s has neither mass nor constraint", t,
                     hn_dense_ode_name(&p->ode, i));
            return HN_ERR_SINGULAR;
        }
        p->scale[i] = 1 / sqrt(g);
    }
    for (int k = 0; k < p->n_G; k++) {
        p->G[k] *= p->scale[p->G_row[k]] * p->scale[p->G_col[k]];
    }

    // factor
    p->ode.base.cost.factorisations++;
    p->ode.base.cost.ops += 2.0 * p->n_G + hn_sparse_spd_factor_ops(p->spd);
    if (hn_sparse_spd_factor(p->spd, p->G, 4 * nv * DBL_EPSILON) != HN_OK) {
        snprintf(
            p->ode.base.why, sizeof p->ode.base.why,
            "at t = %.6g s the penalty %.3g is too large: the masses are lost to rounding, or a "
            "direction has neither mass nor constraint",
            t, weight);
        return HN_ERR_SINGULAR;
    }
    return HN_OK;
}

void hn_penalised_solve(hn_penalised *p, double *x) {
    const int nv = p->ode.base.nv;
    for (int i = 0; i < nv; i++) {
        x[i] *= p->scale[i];
    }
    hn_sparse_spd_solve(p->spd, x);
    for (int i = 0; i < nv; i++) {
        x[i] *= p->scale[i];
    }
    p->ode.base.cost.solves++;
    p->ode.base.cost.ops += 2.0 * nv + hn_sparse_spd_solve_ops(p->spd);
}

hn_status hn_penalised_set(void *self, int option, double value) {
    hn_penalised *p = self;
    switch (option) {
    case HN_PENALISED_A:
        p->a = value;
        return HN_OK;
    case HN_PENALISED_OMEGA:
        p->omega = value;
        return HN_OK;
    case HN_PENALISED_XI:
        p->xi = value;
        return HN_OK;
    default:
        return HN_ERR_UNSUPPORTED;
    }
}
