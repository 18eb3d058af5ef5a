#ifndef HN_INTEGRATORS_DAE_H
#define HN_INTEGRATORS_DAE_H
// Integrators that take the differential-algebraic system itself instead of an ordinary differential equation made of it.
//
//     q' = G(q) v [+ G M^-1 J' mu],   M v' = f + J' lambda,   with one of
//     INDEX3  phi = 0          INDEX2  J v + phi_t = 0          GGL  both, with mu          INDEX1  J v' + gamma = 0      (1)
//
// The formulation says which form (hn_formulation.form), the stepper which forms it serves (hn_stepper.forms). Between
// steps the state is y = (q, v) in system coordinates, nq + nv entries; multipliers, auxiliary accelerations and histories
// are the integrator's own. Increments of q are taken along G(q) (hn_system_move), so quaternions need no row of their own.

#include "base/arena.h"
#include "base/diag.h"
#include "formulations/ground/formulation.h"

struct hn_dae_stepper {
    /// An instance for one form. `settings` in the stepper's table order, `form_settings` in the formulation's. Refuses what it cannot serve
    /// with the reason in diag (HN_ERR_UNSUPPORTED). Memory from `arena`.
    hn_status (*create)(const hn_system *sys, hn_dae_form form, const double *settings,
                        const double *form_settings, hn_arena *arena, void **self, hn_diag *diag);
    void (*destroy)(void *self);
    /// Begins at a state, forgetting everything before: consistent multipliers, accelerations, histories.
    hn_status (*start)(void *self, double t, const double *y);
    /// One trial step of size h from (t, y) to y_new; err (nq + nv) receives the error estimate when adaptive. Leaves y, and what start
    /// or the last accepted step left, as they were, so that a trial can be repeated with another h.
    hn_status (*step)(void *self, double t, double h, const double *y, double *y_new, double *err);
    /// One step whose size the integrator chooses itself, from (t, y) to (*t_new, y_new), not beyond t_stop (HUGE_VAL: no
    /// bound); then `step` is not called and may be NULL. NULL: the run chooses the size.
    hn_status (*advance)(void *self, double t, double t_stop, const double *y, double *t_new,
                         double *y_new);
    /// The trial became the state. `changed` 1: y_new was changed afterwards.
    void (*accepted)(void *self, int changed);
    /// y at t + theta h in the step just accepted; NULL: none.
    void (*dense)(void *self, double theta, double *y);
    /// The scheme's own multipliers at the end of the last accepted step (nc), NULL: none. They converge with a lower
    /// order than the state, or not at all: multipliers for output are recomputed from the saddle system.
    const double *(*raw_lambda)(const void *self);
    void (*add_cost)(const void *self, hn_cost *cost);
    const char *(*why)(const void *self); ///< reason of the last failure, or NULL
};

#endif
