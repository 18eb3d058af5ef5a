// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_STAGES_H
#define HN_INTEGRATORS_STAGES_H
// The stages of a collocation method by simplified Newton iteration, whatever the equations are:
//
//     R(t + c_i h, Z_i, Z'_i, L_i) = 0,   Z'_i = 1/h sum_j (A^-1)_ij Z_j,   i = 1 .. stages   (1)
//
// Z_i are increments of what is differentiated (n_diff), L_i what is not (n_alg). With the
// derivatives of R frozen at the start of the step the corrections fall apart, in the basis of
// integrators/implicit/implicit_tableau.h, into one system with the real number s = gamma / h in
// the place of d/dt and one with the complex number s = (alpha - i beta) / h. Source: Hairer &
// Wanner 1996, section IV.8; stopping rule there, eq. (8.10).

#include "base/arena.h"
#include "base/status.h"
#include "integrators/implicit/implicit_tableau.h"

enum { HN_STAGES_WHY = 200 };

/// A vector in the basis of (1): real, or a complex one as two parts.
typedef struct hn_parts {
    int n; ///< 1: real, 2: real and imaginary
    double *at[2];
} hn_parts;

/// The equations. All arrays of one stage are (n_diff + n_alg): Z, then L.
typedef struct hn_stage_equations {
    void *self;
    int n_diff, n_alg;
    /// R of one stage at time t; rate = Z' (n_diff).
    hn_status (*residual)(void *self, int stage, double t, const double *u, const double *rate,
                          double *r);
    /// Factors dR with s = (re, im) in the place of d/dt; which = 0: real, 1: complex. Fails:
    /// HN_ERR_SINGULAR, HN_ERR_DIVERGED.
    hn_status (*factor)(void *self, int which, double re, double im);
    /// Takes the derivatives anew at a stage's u and Z' instead of the start of the step; NULL: not
    /// possible.
    hn_status (*relinearise)(void *self, double t, const double *u, const double *rate);
    /// r <- the correction u with dR u = -r.
    void (*solve)(void *self, hn_parts r);
} hn_stage_equations;

typedef struct hn_stages {
    hn_collocation col;
    hn_stage_equations eq;
    int n;             ///< n_diff + n_alg
    double *u;         ///< stages x n: solution; filled by the caller with a first guess
    double *rate;      ///< stages x n_diff: Z' of the solution
    double *r, *parts; ///< stages x n scratch
    double *scale;     ///< n_diff: sizes that corrections are measured by, set by the caller
    double tol;        ///< corrections at or below are negligible; 0: go on to rounding
    double floor;      ///< of the scale: what rounding of the equations leaves in a correction
    long long iterations, factorisations, solves, residuals;
    char why[HN_STAGES_WHY];
} hn_stages;

/// Memory for the arrays. Fails with HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_stages_init(hn_stages *nw, const hn_collocation *col,
                                       const hn_stage_equations *eq, hn_arena *arena);
/// Solves (1) for a step of size h from t. Fails: HN_ERR_NO_CONVERGENCE, HN_ERR_SINGULAR,
/// HN_ERR_DIVERGED, or what the residual says; `why` then tells in words. Allocates nothing.
HN_MUST_CHECK hn_status hn_stages_solve(hn_stages *nw, double t, double h);
/// y1 - y0 of the part that is differentiated (n_diff), and the same at t + theta h.
void hn_stages_end(const hn_stages *nw, double *z);
void hn_stages_dense(const hn_stages *nw, double theta, double *z);

#endif
