// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_DENSE_ODE_H
#define HN_FORMULATIONS_DENSE_ODE_H
// Common part of the formulations that compute the acceleration from M, f, J and gamma as dense
// arrays, each by its own formula: the state y = (q, v) in system coordinates and
//
//     q' = G(q) v,    v' = accelerate(M, f, J, gamma, ...)                                    (1)
//
// A formulation's instance begins with an hn_dense_ode, so that the functions below and those of
// hn_state_ode fit its table.

#include "dynamics/evaluate/eval.h"
#include "formulations/ground/state_ode.h"

#include <stdbool.h>

typedef struct hn_dense_ode {
    hn_state_ode base; // first
    hn_eval *eval;
    /// the terms at the state last evaluated, as in eval.h; phi and phi_t only where asked for
    const double *M, *f, *J, *gamma, *phi, *phi_t;
    /// entries of M (lower triangle) and of J that are not identically zero
    int n_M, n_J;
    const int *M_row, *M_col, *J_row, *J_col;
    /// Fills a (nv) from the terms. Allocates nothing. Fails with its reason in `why`; counts its
    /// own work.
    hn_status (*accelerate)(void *self, double t, const double *v, double *a);
} hn_dense_ode;

/// `with_gap`: phi and phi_t are wanted too. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT, told in diag.
HN_MUST_CHECK hn_status hn_dense_ode_init(hn_dense_ode *ode, const hn_system *sys, bool with_gap,
                                          hn_arena *arena, hn_diag *diag);
/// out (nc) = gamma + 2 xi omega (J v + phi_t) + omega^2 phi at the terms last evaluated.
void hn_dense_ode_pull(const hn_dense_ode *ode, const double *v, double omega, double xi,
                       double *out);
/// The size of pivots of J that are blur at the state evaluated last
/// (dynamics/evaluate/pivot_noise.h), with the gap's terms; rate (nc) receives J v + phi_t, size
/// (nc) is scratch.
double hn_dense_ode_blur(const hn_dense_ode *ode, const double *v, double *rate, double *size);
/// y (nc) = J x and x (nv) += J' y, entry by entry.
void hn_dense_ode_rows(const hn_dense_ode *ode, const double *x, double *y);
void hn_dense_ode_add_rows(const hn_dense_ode *ode, const double *y, double *x);
/// Name of the user coordinate behind system coordinate i, for telling.
const char *hn_dense_ode_name(const hn_dense_ode *ode, int i);

/// The slots of hn_formulation for formulations that begin with a dense_ode.
void hn_dense_ode_destroy(void *self);
void hn_dense_ode_get(void *self, hn_ode *out);
void hn_dense_ode_add_cost(const void *self, hn_cost *cost);

#endif
