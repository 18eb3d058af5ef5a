#ifndef HN_DYNAMICS_LAGRANGIAN_H
#define HN_DYNAMICS_LAGRANGIAN_H
// The terms of a Lagrangian scene by exact differentiation, without ever expanding a product:
//
//     p = T_v,  M = p_v,  h = p_q v - T_q + V_q,  f = Q - h                                            (1)
//     J = phi_q,  phi' = J v + phi_t,  gamma = phi'_q v + phi'_t                                       (2)
//
// p_q v and gamma are directional derivatives (one forward sweep each), T_q and V_q gradients (one reverse sweep each).
// Source: Griewank & Walther 2008, ch. 3.

#include "base/diag.h"
#include "expr/graph.h"

typedef struct hn_lagrange_input {
    int n, m;         ///< coordinates, constraints
    const int *q, *v; ///< their symbols and those of their rates
    int t;            ///< symbol of time
    hn_ex kinetic, potential;
    const hn_ex *constraints; ///< m
    const hn_ex *force;       ///< n: generalised forces Q
} hn_lagrange_input;

/// Writes M (n x n, both triangles the same), f (n), J (m x n), phi_t (m), gamma (m). Fails: HN_ERR_INPUT when the kinetic energy is not
/// a quadratic form in the rates that is free of time, or the potential energy depends on the rates; HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_lagrange_terms(hn_graph *g, const hn_lagrange_input *in, hn_ex *M,
                                          hn_ex *f, hn_ex *J, hn_ex *phi_t, hn_ex *gamma,
                                          hn_diags *diags);
#endif
