#include "methods/penalised.h"

#include "linalg/dense.h"
#include "methods/flops.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

hn_status hn_penalised_init(hn_penalised *p, const hn_system *sys, const double *settings,
                            hn_arena *arena, hn_diag *diag) {
    const hn_status status = hn_dense_ode_init(&p->ode, sys, 1, arena, diag);
    if (status != HN_OK) {
        return status;
    }
    const size_t nv = (size_t)p->ode.nv, nc = (size_t)p->ode.nc;
    p->a = settings[HN_PENALISED_A];
    p->omega = settings[HN_PENALISED_OMEGA];
    p->xi = settings[HN_PENALISED_XI];
    p->G = hn_arena_doubles(arena, nv * nv);
    p->scale = hn_arena_doubles(arena, nv);
    p->pull = hn_arena_doubles(arena, nc);
    p->work = hn_arena_doubles(arena, nc);
    return hn_arena_failed(arena) ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory")
                                  : HN_OK;
}

// lower triangle of M + weight J' J, row by row of J because most of its entries are zero
static void fill(hn_penalised *p, double weight) {
    const int nv = p->ode.nv, nc = p->ode.nc;
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j <= i; j++) {
            p->G[(size_t)i * nv + j] = p->ode.M[(size_t)i * nv + j];
        }
    }
    for (int k = 0; k < nc; k++) {
        const double *row = p->ode.J + (size_t)k * nv;
        for (int i = 0; i < nv; i++) {
            if (row[i] != 0) {
                hn_axpy(i + 1, weight * row[i], row, p->G + (size_t)i * nv);
                p->ode.cost.ops += 2 * (i + 1);
            }
        }
    }
}

hn_status hn_penalised_factor(hn_penalised *p, double t, double weight) {
    const int nv = p->ode.nv;
    fill(p, weight);
    for (int i = 0; i < nv; i++) {
        const double g = p->G[(size_t)i * nv + i];
        if (!(g > 0)) {
            snprintf(p->ode.why, sizeof p->ode.why,
                     "at t = %.6g s %s has neither mass nor constraint", t,
                     hn_dense_ode_name(&p->ode, i));
            return HN_ERR_SINGULAR;
        }
        p->scale[i] = 1 / sqrt(g);
    }
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j <= i; j++) {
            p->G[(size_t)i * nv + j] *= p->scale[i] * p->scale[j];
        }
    }
    p->ode.cost.factorisations++;
    p->ode.cost.ops += hn_flops_cholesky(nv);
    if (hn_cholesky(nv, p->G, nv, 4 * nv * DBL_EPSILON) != HN_OK) {
        snprintf(
            p->ode.why, sizeof p->ode.why,
            "at t = %.6g s the penalty %.3g has drowned the masses in rounding, or a direction "
            "has neither mass nor constraint",
            t, weight);
        return HN_ERR_SINGULAR;
    }
    return HN_OK;
}

void hn_penalised_solve(hn_penalised *p, double *x) {
    const int nv = p->ode.nv;
    for (int i = 0; i < nv; i++) {
        x[i] *= p->scale[i];
    }
    hn_cholesky_solve(nv, p->G, nv, x);
    for (int i = 0; i < nv; i++) {
        x[i] *= p->scale[i];
    }
    p->ode.cost.solves++;
    p->ode.cost.ops += hn_flops_cholesky_solve(nv);
}

void hn_penalised_add_rows(const hn_penalised *p, const double *y, double *x) {
    for (int k = 0; k < p->ode.nc; k++) {
        hn_axpy(p->ode.nv, y[k], p->ode.J + (size_t)k * p->ode.nv, x);
    }
}

hn_status hn_penalised_set(void *self, int setting, double value) {
    hn_penalised *p = self;
    switch (setting) {
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
