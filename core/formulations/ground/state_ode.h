// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_STATE_ODE_H
#define HN_FORMULATIONS_STATE_ODE_H
// Common part of the formulations whose state is y = (q, v) in system coordinates:
//
//     q' = G(q) v,    v' = the accelerations that obey a law (accel_jacobian.h)               (1)
//
// A formulation's instance begins with an hn_state_ode, so that the functions below fit its table.

#include "formulations/ground/accel_jacobian.h"
#include "formulations/ground/formulation.h"

enum { HN_WHY_TEXT = 240 };

typedef struct hn_state_ode {
    const hn_system *sys;
    int nq, nv, nc;
    /// The law that the accelerations obey now, for their derivatives; NULL: that of index-1.
    /// `give` does not change.
    hn_accel_law (*law)(const void *self);
    double *unit; ///< nq: positions with quaternions of length 1
    hn_arena *arena;
    hn_accel_jacobian *slopes; ///< NULL until an implicit integrator asks
    hn_cost cost;              ///< what the evaluators do not count themselves
    char why[HN_WHY_TEXT];
} hn_state_ode;

/// Memory from `arena`; `law` is left as it is. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_state_ode_init(hn_state_ode *ode, const hn_system *sys, hn_arena *arena);
void hn_state_ode_destroy(hn_state_ode *ode);
/// The equations with this right-hand side, and with exact derivatives.
void hn_state_ode_get(void *self, hn_status (*rhs)(void *, double, const double *, double *),
                      hn_ode *out);
hn_status hn_state_ode_set_state(void *self, double t, const double *q, const double *v, double *y);
hn_status hn_state_ode_get_state(void *self, double t, const double *y, double *q, double *v);
/// After a step: quaternions of balls back to length 1; `changed` only where that moved them by
/// more than rounding.
hn_status hn_state_ode_after_step(void *self, double t, double *y, int *changed);
void hn_state_ode_add_cost(const void *self, hn_cost *cost); ///< `cost` above, and of derivatives
const char *hn_state_ode_why(const void *self);

#endif
