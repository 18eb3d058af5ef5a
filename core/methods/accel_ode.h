#ifndef HN_METHODS_ACCEL_ODE_H
#define HN_METHODS_ACCEL_ODE_H
// What index-1, Baumgarte and projection share: the state y = (q, v) in system coordinates and the right-hand side
//
//     q' = G(q) v,    v' = a   from   K [a; -lambda] = [f; -gamma - 2 alpha (J v + phi_t) - beta^2 phi]        (1)
//
// A formulation's instance begins with an hn_accel_ode, so that the functions below fit its table.

#include "dynamics/eval.h"
#include "methods/accel_jacobian.h"
#include "methods/method.h"

enum { HN_WHY_TEXT = 240 };

typedef struct hn_accel_ode {
    const hn_system *sys;
    int nq, nv, nc;
    hn_accel *accel;
    int baumgarte;
    double alpha, beta; ///< [1/s], used with baumgarte
    double *unit;       ///< nq: positions with quaternions of length 1
    hn_arena *arena;
    hn_accel_jacobian *slopes; ///< NULL until an implicit integrator asks
    hn_cost cost;              ///< what the evaluator does not count itself
    char why[HN_WHY_TEXT];
} hn_accel_ode;

HN_MUST_CHECK hn_status hn_accel_ode_init(hn_accel_ode *ode, const hn_system *sys, int baumgarte,
                                          hn_solver solver, hn_arena *arena, hn_diag *diag);
/// The setting "solver" of the formulations that use this; the value is an hn_solver.
#define HN_ACCEL_ODE_SOLVER_SETTING                                                             \
    {                                                                                           \
        "solver", 0, 0, HN_SOLVER_COUNT - 1, "",                                                \
            "who solves for the accelerations; auto: the tape, refined or least-norm where it " \
            "must be",                                                                          \
            hn_solver_names, HN_SOLVER_COUNT, 0                                                 \
    }
void hn_accel_ode_destroy(void *self);
void hn_accel_ode_get(void *self, hn_ode *out);
hn_status hn_accel_ode_rhs(void *self, double t, const double *y, double *ydot);
hn_status hn_accel_ode_set_state(void *self, double t, const double *q, const double *v, double *y);
hn_status hn_accel_ode_get_state(void *self, double t, const double *y, double *q, double *v);
/// After a step: quaternions of balls back to length 1; `changed` only where that moved them by more than rounding.
hn_status hn_accel_ode_after_step(void *self, double t, double *y, int *changed);
void hn_accel_ode_add_cost(const void *self, hn_cost *cost);
const char *hn_accel_ode_why(const void *self);

#endif
