// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_HALF_EXPLICIT_H
#define HN_INTEGRATORS_HALF_EXPLICIT_H
// Half-explicit Runge-Kutta methods on the index-2 system: explicit in everything but the
// multipliers, which each stage chooses so that the speeds of the NEXT one satisfy the constraints.
// With row s + 1 of A equal to b, for i = 1 .. s
//
//     Q_(i+1) = q + h sum_(j <= i) a_(i+1,j) G(Q_j) V_j                                       (1)
//     M(Q_i) k_i = f(Q_i, V_i) + J(Q_i)' l_i,
//     J(Q_(i+1)) (v + h sum_(j <= i) a_(i+1,j) k_j) + phi_t = 0                               (2)
//     V_(i+1) = v + h sum_(j <= i) a_(i+1,j) k_j                                              (3)
//
// (2) has J at two poses: its matrix is not symmetric. Neither gamma nor phi is needed; J v = 0
// holds at every stage, and phi grows with the error of the method alone. Every a_(i+1,i) must
// differ from 0. Source: Brasey & Hairer 1993, Half-explicit Runge-Kutta methods for
// differential-algebraic systems of index 2.

#include "integrators/step/dae.h"

enum { HN_HALF_EXPLICIT_STAGES = 6 };

typedef struct hn_half_explicit {
    int stages, order;
    const double *A; ///< (stages + 1) x stages, row-major, strictly lower; the last row is b
} hn_half_explicit;

extern const hn_half_explicit hn_half_explicit_hem3; ///< 3 stages, order 3
extern const hn_half_explicit hn_half_explicit_hem4; ///< 5 stages, order 4
/// the classical tableau, order 3 when used like this
extern const hn_half_explicit hn_half_explicit_rk4;

/// For the slots of hn_dae_stepper. `doubled`: each step is made once whole and once in halves; the
/// halves are kept and the difference estimates their error (Richardson). `close`: when the
/// position is projected, see hn_dae_closes().
HN_MUST_CHECK hn_status hn_half_explicit_create(const hn_half_explicit *scheme, int doubled,
                                                int close, const hn_system *sys, hn_arena *arena,
                                                void **self, hn_diag *diag);
void hn_half_explicit_destroy(void *self);
hn_status hn_half_explicit_start(void *self, double t, const double *y);
hn_status hn_half_explicit_step(void *self, double t, double h, const double *y, double *y_new,
                                double *err);
void hn_half_explicit_accepted(void *self, int changed);
const double *hn_half_explicit_raw_lambda(const void *self);
void hn_half_explicit_add_cost(const void *self, hn_cost *cost);
const char *hn_half_explicit_why(const void *self);

#endif
