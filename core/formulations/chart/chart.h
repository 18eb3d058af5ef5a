// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_H
#define HN_FORMULATIONS_CHART_H
// A chart of the closed mechanism: velocities split into independent and dependent ones, J = [J_i
// J_d] P, so that
//
//  q_d by Newton on phi = 0,    v = N u + s,   N = [I; -J_d^-1 J_i],   s = [0; -J_d^-1 phi_t]  (1)
//  a = N udot + c,                 c = [0; -J_d^-1 gamma]                                  (2)
//  (N^T M N) udot = N^T (f - M c)                                                          (3)
//
// where u are the independent velocities. N is never differentiated: with this N, Ndot u + sdot is
// exactly c. A chart ends where J_d loses rank (a dead point of the chosen
// coordinates); the motion may go on in another chart.
//
// A square J_d (no redundant rows) is factored sparse, in an order chosen where the chart was
// chosen, and M and J are taken entry by entry, so that an evaluation costs what they hold:
// linearly for a chain of loops. With redundant rows J_d holds rank J columns and is solved in the
// least-squares sense by dense QR, which for consistent rows is exact.
//
// Positions move along velocities (hn_system_move), so ball joints need no chart for their
// position. Their velocities are not the derivatives of coordinates and cannot be integrated alone:
// minimal coordinates keep ball joints dependent (see minimal_state.h).
//
// Null-space, partitioning and reduced coordinates are built on this. Source: Wehage & Haug 1982;
// for which columns to take, Goreinov, Tyrtyshnikov & Zamarashkin 1997 (submatrices of locally
// maximal volume).

#include "formulations/chart/chart_choice.h"
#include "formulations/chart/chart_dependent.h"
#include "formulations/chart/chart_state.h"

#include <stdbool.h>

/// Makes a chart: compiles its terms, with gamma, which c needs, where `with_rate` is set. Its
/// memory is in the arena; hn_chart_destroy() frees the rest. Fails: HN_ERR_MEMORY, reported in
/// diag.
HN_MUST_CHECK hn_status hn_chart_init(hn_chart *chart, const hn_system *sys, bool with_rate,
                                      hn_arena *arena, hn_diag *diag);
void hn_chart_destroy(hn_chart *chart);

/// Closes the loops at `point` for given independent entries of q (nq; the dependent ones are a
/// guess, overwritten). The point then holds q, J, N, s and the factor. Fails: HN_ERR_CHART (no
/// closed configuration was found, or det J_d vanished on the way).
HN_MUST_CHECK hn_status hn_chart_close(hn_chart *chart, hn_chart_point *point, double t, double *q,
                                       double tol);
/// Returns whether a configuration with this gap counts as closed to `tol`; `last` is the gap
/// before the last step of Newton's method.
bool hn_chart_is_closed(const hn_chart *chart, double gap, double last, double tol);
/// Accepts the state in chart->here. Fails: HN_ERR_CHART (det J_d has changed its sign since the
/// last accepted state: the loop went over to its other assembly mode).
HN_MUST_CHECK hn_status hn_chart_settle(hn_chart *chart);
/// Checks the sign of det J_d as hn_chart_settle() does, and accepts nothing. Fails: HN_ERR_CHART.
HN_MUST_CHECK hn_status hn_chart_check_mode(hn_chart *chart);
/// Returns whether `point` was filled at this t and q (nq), so that it need not be filled again.
bool hn_chart_is_at(const hn_chart *chart, const hn_chart_point *point, double t, const double *q);

/// Fills the point at q, closed or not: J, N, s and the factor.
HN_MUST_CHECK hn_status hn_chart_locate(hn_chart *chart, hn_chart_point *point, double t,
                                        const double *q);
/// Computes q (nq) from its independent entries q_ind (r, plain coordinates); predicts the
/// dependent entries along the tangent at chart->base.
void hn_chart_predict(hn_chart *chart, double t, const double *q_ind, double *q);
/// The same along the tangent at another point.
void hn_chart_predict_from(const hn_chart *chart, const hn_chart_point *from, double t,
                           const double *q_ind, double *q);
/// Fails with HN_ERR_CHART: a step of the integrator crossed the configuration in which the two
/// assembly modes of dyad number `step` meet. chart->here is no longer valid.
hn_status hn_chart_fail_dyad(hn_chart *chart, int step);
/// Computes v = N u + s at the point.
void hn_chart_speeds(const hn_chart *chart, const hn_chart_point *point, const double *u,
                     double *v);
/// Computes u' of equation (3) at chart->here with velocities v.
HN_MUST_CHECK hn_status hn_chart_accel(hn_chart *chart, const double *v, double *u_dot);
/// Computes x <- A^-1 x with the r x r matrix of (3), whose lower triangle is in chart->A.
/// Overwrites chart->A.
HN_MUST_CHECK hn_status hn_chart_solve_reduced(hn_chart *chart, double t, double *x);
/// Adds counters and tape operations.
void hn_chart_add_cost(const hn_chart *chart, hn_cost *cost);

#endif
