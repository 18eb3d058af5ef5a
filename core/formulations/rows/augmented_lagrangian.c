// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"
#include "formulations/ground/penalised.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

// lambda_1 = 0, then for k = 1, 2, ...                                                    (1)
//  (M + a J' J) acc_k = f + J' lambda_k - a J' r,
//      r = gamma + 2 xi omega (J v + phi_t) + omega^2 phi
//  lambda_(k+1) = lambda_k - a (J acc_k + r)
//
// Each turn shrinks the error by 1 / (1 + a s), s the smallest nonzero eigenvalue of J M^-1 J'; the
// limit is Baumgarte's acceleration with alpha = xi omega, beta = omega, and lambda stays in the
// range of J: of least norm where rows repeat. acc_k is found as a correction of acc_(k-1), so that
// a strong penalty costs condition but no digits. Every right-hand side starts anew from 0, so that
// it depends on the state alone.
//
// a = 0 on the card asks for 1e5 / s with s the median of J_i diag(M)^-1 J_i', the scale of J M^-1
// J' without a solve.

enum { OPT_ITERATIONS = HN_PENALISED_OPTIONS, N_OPTIONS };
#define AUTO_WEIGHT 1e5

typedef struct augmented {
    hn_penalised p; // first
    int iterations;
    double *lambda;   // nc
    double *residual; // nv
} augmented;

static double choose_weight(augmented *al) {
    if (al->p.a > 0) {
        return al->p.a;
    }
    const double typical = hn_penalised_typical_mobility(&al->p);
    return typical > 0 ? AUTO_WEIGHT / typical : AUTO_WEIGHT;
}

// residual (nv) = f - M acc + J' (lambda - weight (J acc + r)): what (1) still misses at acc
static void find_residual(augmented *al, double weight, const double *acc) {
    const hn_dense_ode *ode = &al->p.ode;
    const size_t nv = (size_t)ode->base.nv;
    hn_dense_ode_rows(ode, acc, al->p.work);
    for (int k = 0; k < ode->base.nc; k++) {
        al->p.work[k] = al->lambda[k] - weight * (al->p.work[k] + al->p.pull[k]);
    }
    memcpy(al->residual, ode->f, nv * sizeof *al->residual);
    for (int k = 0; k < ode->n_M; k++) {
        const size_t i = (size_t)ode->M_row[k], j = (size_t)ode->M_col[k];
        const double m = ode->M[i * nv + j];
        al->residual[i] -= m * acc[j];
        al->residual[j] -= i != j ? m * acc[i] : 0;
    }
    hn_dense_ode_add_rows(ode, al->p.work, al->residual);
}

static hn_status accelerate(void *self, double t, const double *v, double *acc) {
    augmented *al = self;
    hn_penalised *p = &al->p;
    const int nv = p->ode.base.nv, nc = p->ode.base.nc;
    const double weight = choose_weight(al);
    hn_dense_ode_pull(&p->ode, v, p->omega, p->xi, p->pull);
    HN_TRY(hn_penalised_factor(p, t, weight));

    // iterate from lambda = 0, so that the result depends on the state alone
    memset(al->lambda, 0, (size_t)nc * sizeof *al->lambda);
    memset(acc, 0, (size_t)nv * sizeof *acc);
    for (int i = 0; i < al->iterations; i++) {
        find_residual(al, weight, acc);
        hn_penalised_solve(p, al->residual);
        hn_axpy(nv, 1, al->residual, acc);
        hn_dense_ode_rows(&p->ode, acc, p->work);
        for (int k = 0; k < nc; k++) {
            al->lambda[k] -= weight * (p->work[k] + p->pull[k]);
        }
        p->ode.base.cost.newton++;
        p->ode.base.cost.ops += 6.0 * p->ode.n_J + 4.0 * p->ode.n_M + 6.0 * nc;
    }

    p->ode.base.cost.ops += 5.0 * p->ode.n_J;
    return HN_OK;
}

// of the limit that the turns of (1) approach
static hn_accel_law law(const void *self) {
    const hn_penalised *p = self;
    return (hn_accel_law){p->xi * p->omega, p->omega, 0};
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    augmented *al = hn_arena_get(arena, sizeof *al);
    if (!al) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = al;
    al->p.ode.accelerate = accelerate;
    al->p.ode.base.law = law;
    al->iterations = (int)options[OPT_ITERATIONS];
    HN_TRY(hn_penalised_init(&al->p, sys, options, arena, diag));
    al->lambda = hn_arena_doubles(arena, (size_t)al->p.ode.base.nc);
    al->residual = hn_arena_doubles(arena, (size_t)al->p.ode.base.nv);
    return hn_arena_failed(arena) ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory")
                                  : HN_OK;
}

static hn_status set(void *self, int option, double value) {
    augmented *al = self;
    if (option == OPT_ITERATIONS) {
        al->iterations = (int)value;
        return HN_OK;
    }
    return hn_penalised_set(self, option, value);
}

const hn_formulation hn_formulation_augmented_lagrangian = {
    .name = "augmented-lagrangian",
    .title = "augmented Lagrangian",
    .short_name = "augm. Lagr.",
    .rule = "Solve with a moderate penalty, compute the loop force from it, apply this force and "
            "repeat. A few iterations reach an accuracy that a penalty alone does not have.",
    .drift = "as Baumgarte with alpha = xi omega and beta = omega: bounded, fed by "
             "truncation error",
    .when = "redundant constraints, motions through singular configurations; the "
            "multipliers stay bounded",
    .when_not = "very different masses in one loop (needs more iterations); close to a "
                "singular configuration (energy is lost there); omega h beyond the "
                "integrator's stability limit",
    .source = "Bayo, Garcia de Jalon & Serna 1988; Bayo & Avello 1994",
    .needs = "M f phi J gamma",
    .index = 1,
    .traits = HN_TRAIT_PULLS_GAP | HN_TRAIT_ADDS_VIBRATIONS,
    .n_options = N_OPTIONS,
    .options =
        {
            [HN_PENALISED_A] = {.key = "a",
                                .max = 1e15,
                                .about =
                                    "penalty weight; 0: 1e5 times the typical mass at the loop"},
            [HN_PENALISED_OMEGA] = {.key = "omega",
                                    .initial = 10,
                                    .max = 1e6,
                                    .unit = "1/s",
                                    .about = "natural frequency of the gap"},
            [HN_PENALISED_XI] = {.key = "xi",
                                 .initial = 1,
                                 .max = 100,
                                 .about = "damping ratio of the gap; 1: critical"},
            [OPT_ITERATIONS] = {.key = "iterations",
                                .initial = 3,
                                .min = 1,
                                .max = 50,
                                .about = "number of iterations (a whole number)"},
        },
    .create = create,
    .destroy = hn_dense_ode_destroy,
    .ode = hn_dense_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .set = set,
    .add_cost = hn_dense_ode_add_cost,
    .why = hn_state_ode_why,
};
