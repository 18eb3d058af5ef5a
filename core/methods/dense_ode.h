#ifndef HN_METHODS_DENSE_ODE_H
#define HN_METHODS_DENSE_ODE_H
// What the formulations share that get their acceleration from M, f, J and gamma as dense arrays, by their own formula: the
// state y = (q, v) in system coordinates and
//
//     q' = G(q) v,    v' = accelerate(M, f, J, gamma, ...)                                             (1)
//
// A formulation's instance begins with an hn_dense_ode, so that the functions below fit its table.

#include "dynamics/eval.h"
#include "methods/accel_jacobian.h"
#include "methods/method.h"

enum { HN_DENSE_WHY_TEXT = 200 };

typedef struct hn_dense_ode {
    const hn_system *sys;
    int nq, nv, nc;
    hn_eval *eval;
    /// the terms at the state last evaluated, as in eval.h; phi and phi_t only where asked for
    const double *M, *f, *J, *gamma, *phi, *phi_t;
    /// entries of M (lower triangle) and of J that are not identically zero
    int n_M, n_J;
    const int *M_row, *M_col, *J_row, *J_col;
    /// Fills a (nv) from the terms. Allocates nothing. Fails with its reason in `why`; counts its own work.
    hn_status (*accelerate)(void *self, double t, const double *v, double *a);
    /// The law that the accelerations obey, for their derivatives; NULL: that of index-1. Entries that are zero at first stay so.
    hn_accel_law (*law)(const void *self);
    double *unit; ///< nq: positions with quaternions of length 1
    hn_arena *arena;
    hn_accel_jacobian *slopes; ///< NULL until an implicit integrator asks
    hn_cost cost;              ///< what the evaluator does not count itself
    char why[HN_DENSE_WHY_TEXT];
} hn_dense_ode;

/// `with_gap`: phi and phi_t are wanted too. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT, told in diag.
HN_MUST_CHECK hn_status hn_dense_ode_init(hn_dense_ode *ode, const hn_system *sys, int with_gap,
                                          hn_arena *arena, hn_diag *diag);
/// out (nc) = gamma + 2 xi omega (J v + phi_t) + omega^2 phi at the terms last evaluated.
void hn_dense_ode_pull(const hn_dense_ode *ode, const double *v, double omega, double xi,
                       double *out);
/// y (nc) = J x and x (nv) += J' y, entry by entry.
/// The size of pivots of J that are blur at the state evaluated last (dynamics/blur.h), with the gap's terms; rate (nc) receives
/// J v + phi_t, size (nc) is scratch.
double hn_dense_ode_blur(const hn_dense_ode *ode, const double *v, double *rate, double *size);
void hn_dense_ode_rows(const hn_dense_ode *ode, const double *x, double *y);
void hn_dense_ode_add_rows(const hn_dense_ode *ode, const double *y, double *x);
/// Name of the user coordinate behind system coordinate i, for telling.
const char *hn_dense_ode_name(const hn_dense_ode *ode, int i);

void hn_dense_ode_destroy(void *self);
void hn_dense_ode_get(void *self, hn_ode *out);
hn_status hn_dense_ode_set_state(void *self, double t, const double *q, const double *v, double *y);
hn_status hn_dense_ode_get_state(void *self, double t, const double *y, double *q, double *v);
/// After a step: quaternions of balls back to length 1; `changed` only where that moved them by more than rounding.
hn_status hn_dense_ode_after_step(void *self, double t, double *y, int *changed);
void hn_dense_ode_add_cost(const void *self, hn_cost *cost);
const char *hn_dense_ode_why(const void *self);

#endif
