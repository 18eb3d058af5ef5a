// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_ODE_H
#define HN_INTEGRATORS_IMPLICIT_ODE_H
// Collocation methods on an ordinary differential equation y' = F(t, y): one engine, whose
// functions fit the slots of hn_stepper. Newton's systems are solved by the formulation where it
// offers to (hn_ode_newton); else the Jacobian is the formulation's own where it gives one, else
// differences of F.

#include "integrators/implicit/implicit_tableau.h"
#include "integrators/step/stepper.h"

/// Memory for n = n_pos + n_vel entries; NULL when the arena has run out.
void *hn_implicit_ode_create(const hn_collocation *col, int n, hn_arena *arena);
/// Tolerances of an adaptive method, that its Newton iterations stop by and its estimate is
/// filtered by; rtol 0: to rounding.
void hn_implicit_ode_set_tolerance(void *self, double rtol, double atol);
hn_status hn_implicit_ode_prepare(void *self, const hn_ode *ode);
hn_status hn_implicit_ode_step(void *self, const hn_ode *ode, double t, double h, const double *y,
                               double *y_new, double *err);
void hn_implicit_ode_accepted(void *self, int changed);
void hn_implicit_ode_dense(void *self, double theta, double *y);
void hn_implicit_ode_add_cost(const void *self, hn_cost *cost);
const char *hn_implicit_ode_why(const void *self);

#endif
