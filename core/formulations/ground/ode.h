// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_ODE_H
#define HN_FORMULATIONS_ODE_H
// The ordinary differential equation y' = F(t, y) that a formulation makes of a system, as
// integrators see it.
//
// y = (positions, velocities): n_pos entries, then n_vel. The formulation decides which positions
// and velocities these are.

#include "base/status.h"

#include <stdbool.h>

/// Newton's systems of an implicit integrator, solved by the structure of the equations; the matrix
/// dF/dy itself is full and hides that structure. `self` is that of the hn_ode.
typedef struct hn_ode_newton {
    /// Takes derivatives at (t, y). Fails as rhs does.
    hn_status (*at)(void *self, double t, const double *y);
    /// Factors s - dF/dy with s = (re, im); which = 0: real, 1: complex.
    /// Fails: HN_ERR_SINGULAR, HN_ERR_DIVERGED.
    hn_status (*factor)(void *self, int which, double re, double im);
    /// x (n_pos + n_vel, in 1 or 2 parts: real and imaginary) <- (s - dF/dy)^-1 x with that factor.
    void (*solve)(void *self, int parts, double *const *x);
} hn_ode_newton;

typedef struct hn_ode {
    int n_pos, n_vel;
    void *self;
    /// Evaluates y' (n_pos + n_vel) at (t, y). When it fails ydot is undefined.
    hn_status (*rhs)(void *self, double t, const double *y, double *ydot);
    /// Evaluates the position part of y' only (partitioned integrators call it with new
    /// velocities).
    hn_status (*kinematics)(void *self, double t, const double *y, double *pos_dot);
    /// Evaluates dF/dy at (t, y), (n_pos + n_vel) square, row-major, for implicit integrators.
    /// Fails as rhs does. NULL: integrators take differences. Derivatives by a quaternion, whose
    /// length no motion changes, are along rotations.
    hn_status (*jacobian)(void *self, double t, const double *y, double *jac);
    const hn_ode_newton *newton; ///< NULL: not offered
    /// Units of the absolute tolerance of each entry (n_pos + n_vel), see
    /// hn_tolerance_units() in integrators/step/control.h; NULL: all 1.
    const double *unit;
    /// Flags (n_pos) of the positions that are angles: relative to a whole turn, see
    /// hn_tolerance_size() there; NULL: none.
    const bool *is_angle;
    /// Reserves the memory that jacobian and newton need from the formulation's arena; otherwise
    /// their first call does so. NULL: they need none.
    hn_status (*prepare)(void *self);
} hn_ode;

/// One step of the integrator, for a formulation that makes its own step out of several of them.
typedef struct hn_step_call {
    void *stepper;
    const hn_ode *ode;
    hn_status (*step)(void *stepper, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err);
    void (*on_accepted)(void *stepper, int changed);
} hn_step_call;

/// Makes the step from (t, y), which need not be where the last step began.
static inline hn_status hn_step_call_make(const hn_step_call *call, double t, double h,
                                          const double *y, double *y_new, double *err) {
    call->on_accepted(call->stepper, 1); // slopes kept for a repeated trial belong to another y
    return call->step(call->stepper, call->ode, t, h, y, y_new, err);
}

#endif
