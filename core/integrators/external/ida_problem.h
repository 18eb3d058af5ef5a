// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IDA_PROBLEM_H
#define HN_INTEGRATORS_IDA_PROBLEM_H
// The equations as SUNDIALS IDA takes them: a residual F(t, y, y') = 0 in y = (q, v, lambda [,
// mu]), n entries,
//
//     q' - G(q) v                   nq rows;  with mu: M (q' - v) - J' mu                     (1)
//     M v' - f - J' lambda          nv rows                                                   (2)
//     one per constraint row that is kept:
//       INDEX1      J v' + gamma
//       STABILISED  J v' + gamma + 2 alpha (J v + phi_t) + beta^2 phi
//       INDEX2      J v + phi_t
//       INDEX3      phi
//       GGL         J v + phi_t, and phi                                                      (3)
//
// Weighting the kinematics of (1) by M makes the correction M^-1 J' mu, the smallest one in the
// sense of kinetic energy, without inverting M. Rows of J that depend on others are left out: their
// multipliers are 0, and the matrix of Newton's method stays regular. They are chosen at the
// start, and anew where those that are kept come to depend on each other. Source: Gear, Leimkuhler
// & Gupta 1985; Brenan, Campbell & Petzold 1996, ch. 6.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "integrators/step/dae.h"
#include "linalg/qr.h"

typedef struct hn_ida_problem {
    const hn_system *sys;
    hn_dae_form form;
    int nq, nv, nc;
    int n_kept, *kept; ///< rows of the constraints in use
    int most_kept;     ///< as many are chosen at most; 0: all that are independent
    int n;             ///< nq + nv + n_kept, and n_kept again with mu
    double alpha, beta;
    hn_eval *eval;
    int n_M, n_J; ///< entries of M (lower triangle) and J that are not identically zero, and where
    const int *M_row, *M_col, *J_row, *J_col;
    int *place; ///< nc: which of the kept rows this is; -1: left out
    hn_accel *accel;
    hn_qr qr;
    double *a, *lambda, *work; ///< nv, nc, max(nv, nc)
    double *slope;             ///< 3 (nq + nv)
    double *unit;              ///< nv: of coordinates, so that rows are told apart in any size
    long long residuals;       ///< evaluated so far
} hn_ida_problem;

/// `form_options` are those of the formulation (STABILISED: alpha, beta, ...). Fails:
/// HN_ERR_MEMORY, HN_ERR_LIMIT, HN_ERR_UNSUPPORTED, told in diag.
HN_MUST_CHECK hn_status hn_ida_problem_init(hn_ida_problem *p, const hn_system *sys,
                                            hn_dae_form form, const double *form_options,
                                            hn_arena *arena, hn_diag *diag);
void hn_ida_problem_free(hn_ida_problem *p);
/// Returns whether the kept rows are still about as independent of each other as the best ones at
/// (q, v). Rows that are not let the constraints open that were left out, or another branch of the
/// motion in.
bool hn_ida_problem_rows_hold(hn_ida_problem *p, double t, const double *state);
/// The largest n that any choice of rows leads to.
int hn_ida_problem_room(const hn_ida_problem *p);
/// Chooses the rows and fills y and y' (room) at a state (q, v): speeds and accelerations, lambda
/// from the saddle system, mu = 0, and nothing known of lambda'. Fails like hn_accel_eval().
HN_MUST_CHECK hn_status hn_ida_problem_start(hn_ida_problem *p, double t, const double *state,
                                             double *y, double *ydot);
/// A first step h at which the formula of order 1 that IDA starts with errs by about the tolerance,
/// from the slopes at a state and near it, or a longer one where the rounding of positions over h
/// would exceed the tolerance of velocities. The library's own choice, which makes the first step
/// as small as rtol, loses the multipliers in rounding divided by h when they stand in constraints
/// on speeds or positions. Fails like hn_accel_eval().
HN_MUST_CHECK hn_status hn_ida_problem_first_step(hn_ida_problem *p, double t, const double *state,
                                                  double rtol, double atol, const double *unit,
                                                  double hmax, double *h);
/// Units of the multipliers of the state that hn_ida_problem_start() was given last, in the order
/// of y (n - nq - nv): see hn_tolerance_forces(). `is_chosen`: all are 1.
void hn_ida_problem_units(const hn_ida_problem *p, const double *v, bool is_chosen, double *unit);
/// r (n).
void hn_ida_problem_residual(hn_ida_problem *p, double t, const double *y, const double *ydot,
                             double *r);
/// The multipliers of all rows (nc) from y; 0 for the rows left out.
void hn_ida_problem_lambda(const hn_ida_problem *p, const double *y, double *lambda);
/// Arithmetic operations of one residual.
double hn_ida_problem_ops(const hn_ida_problem *p);

#endif
