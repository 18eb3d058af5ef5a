// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_DAE_H
#define HN_INTEGRATORS_IMPLICIT_DAE_H
// Collocation methods on the differential-algebraic system. Unknowns of a stage are the
// displacement X from the start of the step along the speeds (q = q0 moved by X), the change W of
// the speeds, the multipliers L, and with GGL mu:
//
//  X' = D(X) (v0 + W) + Y mu,  M(q) W' = f + J' L,  with  phi = 0  |  J v + phi_t = 0  |  both  (1)
//
// where D is the identity but for balls (turns do not add: X is a rotation vector, D the inverse of
// the differential of its exponential), and Y = M^-1 J' at the start of the step; the exact motion
// has mu = 0 whatever Y is. For orders see METHOD cards; Sources: Hairer, Lubich & Roche 1989;
// Gear, Leimkuhler & Gupta 1985; Hairer, Lubich & Wanner 2006, IV.7 (turns).

#include "integrators/implicit/implicit_tableau.h"
#include "integrators/step/dae.h"

typedef struct hn_implicit_dae_opts {
    /// 1: the constraint is asked for at the end of the step instead of at the stages (one stage
    /// only).
    int at_end;
    int close;    ///< of index 2, see hn_dae_closes()
    int projects; ///< 1, index 3: the speeds are projected at the end of each step
    /// of an adaptive method; rtol 0: Newton's method goes on to rounding, no error estimate
    double rtol, atol;
    bool default_atol; ///< of an adaptive method: the user chose none, see hn_tolerance_units()
} hn_implicit_dae_opts;

/// Prepares the collocation method `col` for constraints of this form. Returns in *self, which
/// lives in the arena. Fails: HN_ERR_MEMORY and what the compilation of its terms reports, in diag.
HN_MUST_CHECK hn_status hn_implicit_dae_create(const hn_system *sys, hn_dae_form form,
                                               const hn_collocation *col,
                                               const hn_implicit_dae_opts *opts, hn_arena *arena,
                                               void **self, hn_diag *diag);
// the slots of hn_dae_stepper
void hn_implicit_dae_destroy(void *self);
hn_status hn_implicit_dae_start(void *self, double t, const double *y);
hn_status hn_implicit_dae_step(void *self, double t, double h, const double *y, double *y_new,
                               double *err);
void hn_implicit_dae_accepted(void *self, int changed);
void hn_implicit_dae_dense(void *self, double theta, double *y);
const double *hn_implicit_dae_raw_lambda(const void *self);
void hn_implicit_dae_add_cost(const void *self, hn_cost *cost);
const char *hn_implicit_dae_why(const void *self);

#endif
