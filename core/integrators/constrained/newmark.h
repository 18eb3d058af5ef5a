// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_NEWMARK_H
#define HN_INTEGRATORS_NEWMARK_H
// Common part of generalised-alpha and HHT: Newmark's formulas for the motion and Newton's method
// on the equilibrium at the end.
//
//     q1 = q0 + D,  D = h v0 + h^2 ((1/2 - beta) a0 + beta a1) [+ M0^-1 J0' eta]              (1)
//     v1 = v0 + h ((1 - gamma) a0 + gamma a1)                                                 (2)
//     M(q1) e = f(q1, v1) + J(q1)' lambda - carry,    e = weight a1 + past                    (3)
//     phi(q1) = 0   [and J(q1) v1 + phi_t = 0 with eta: the stabilised index-2 form]          (4)
//
// a is an auxiliary that approximates accelerations; each method has its own e, past and carry. D
// is taken along the velocities (hn_system_move), so that ball joints turn about their own axes.
// Newton's unknowns are D, eta and beta h^2 lambda: with (3) times beta h^2 the matrix stays well
// conditioned for every h. In a large mechanism M0^-1 J0' eta is an unknown of its own. Source:
// Arnold, Bruls & Cardona 2015; Bottasso, Dopico & Trainelli 2008 (scaling).

#include "dynamics/evaluate/linearise.h"
#include "integrators/step/dae_base.h"

#include <stdbool.h>

typedef struct hn_newmark {
    hn_dae_base base; ///< first
    bool stabilised;  ///< with eta
    double beta, gamma, weight;
    hn_linear *rest;     ///< R, phi, J v + phi_t
    hn_linear *matrices; ///< M, K, C, J, V
    hn_newton_matrix *matrix;
    double *a0, *past, *carry; ///< nv each: of (1) to (3), set by the method before a step
    double *guess;             ///< nc: multipliers to begin with, set by the method before a step
    double *a1, *e;            ///< nv each: found
    double *lambda;            ///< nc: found, 0 on rows left out
    // the rest is the step's own
    double *D, *eta, *scaled, *P, *factor, *x, *v1;
    double *pushed; ///< nv: M0^-1 J0' eta
} hn_newmark;

/// The part of a step's result that the next step needs.
typedef struct hn_newmark_carried {
    double *a, *e;  ///< nv each: auxiliary and equilibrium of (3) (accelerations or forces)
    double *lambda; ///< nc
} hn_newmark_carried;

/// Memory for systems (nv, nc); a failure shows in the arena.
void hn_newmark_carried_init(hn_newmark_carried *c, hn_arena *arena, size_t nv, size_t nc);

/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT, with the reason in diag.
HN_MUST_CHECK hn_status hn_newmark_init(hn_newmark *s, const hn_system *sys, bool stabilised,
                                        hn_arena *arena, hn_diag *diag);
void hn_newmark_destroy(hn_newmark *s);
/// Solves (1) to (4); y_new receives (q1, v1). Fails with its reason in base.why.
HN_MUST_CHECK hn_status hn_newmark_step(hn_newmark *s, double t, double h, const double *y,
                                        double *y_new);
void hn_newmark_add_cost(const void *self, hn_cost *cost);
const char *hn_newmark_why(const void *self);

#endif
