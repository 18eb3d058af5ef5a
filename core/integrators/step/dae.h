// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_DAE_H
#define HN_INTEGRATORS_DAE_H
// Integrators that take the differential-algebraic system itself instead of an ordinary
// differential equation made from it.
//
//  q' = G(q) v [+ G M^-1 J' mu],   M v' = f + J' lambda,   with one of                     (1)
//  INDEX3 phi = 0;  INDEX2 J v + phi_t = 0;  GGL both, with mu;  INDEX1 J v' + gamma = 0
//
// The formulation names the form (hn_formulation.form), the stepper names the forms it serves
// (hn_stepper.forms). Between steps the state is y = (q, v) in system coordinates, nq + nv entries;
// multipliers, auxiliary accelerations and histories belong to the integrator. Increments of q are
// taken along G(q) (hn_system_move), so quaternions need no constraint of their own.

#include "base/arena.h"
#include "base/diag.h"
#include "formulations/ground/formulation.h"

struct hn_dae_stepper {
    /// Makes an instance for one form, with memory from `arena`. `options` in the stepper's table
    /// order, `form_options` in the formulation's (see the enums beside hn_dae_form). Fails:
    /// HN_ERR_UNSUPPORTED with the reason in diag for what it cannot serve; HN_ERR_MEMORY;
    /// HN_ERR_LIMIT.
    hn_status (*create)(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag);
    void (*destroy)(void *self);
    /// Begins at a state and forgets the past: consistent multipliers, accelerations, histories.
    hn_status (*start)(void *self, double t, const double *y);
    /// Makes one trial step of size h from (t, y) to y_new; err (nq + nv) receives the error
    /// estimate when adaptive. Changes neither y nor what start or the last accepted step left, so
    /// that a trial can be repeated with another h.
    hn_status (*step)(void *self, double t, double h, const double *y, double *y_new, double *err);
    /// Makes one step whose size the integrator chooses itself, from (t, y) to (*t_new, y_new), not
    /// beyond t_stop (HUGE_VAL: no bound); then `step` is not called and may be NULL. NULL: the run
    /// chooses the size.
    hn_status (*advance)(void *self, double t, double t_stop, const double *y, double *t_new,
                         double *y_new);
    /// Called when the trial became the state; changed = 1: y_new was changed afterwards.
    void (*on_accepted)(void *self, int changed);
    /// Dense output of the step just accepted: y at t + theta h. NULL: none.
    void (*dense)(void *self, double theta, double *y);
    /// Returns the scheme's own multipliers at the end of the last accepted step (nc), NULL: none.
    /// They converge with a lower order than the state, or not at all; multipliers for output are
    /// recomputed from the saddle system.
    const double *(*raw_lambda)(const void *self);
    void (*add_cost)(const void *self, hn_cost *cost);
    const char *(*why)(const void *self); ///< reason of the last failure, or NULL
};

#endif
