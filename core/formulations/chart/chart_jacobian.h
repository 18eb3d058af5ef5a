// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_JACOBIAN_H
#define HN_FORMULATIONS_CHART_JACOBIAN_H
// Exact derivatives on a chart (chart.h), by the chain rule over those of accel_jacobian.h: with v
// = N u + s and J v + phi_t = 0,
//
//     dv = N du + [0; -J_d^-1 V dx],      du' = the independent entries of A_x dx + A_v dv    (1)
//
// where A_x and A_v are derivatives of the accelerations, and dx = N du_q where positions stay
// closed. Two solves of the saddle system for each freedom, against as many evaluations by
// differences.

#include "formulations/chart/chart.h"
#include "formulations/ground/accel_jacobian.h"

typedef struct hn_chart_jacobian {
    hn_accel_jacobian *slopes; ///< NULL until an implicit integrator asks
    double *dx, *dv, *da;      ///< nv
    double *du, *du_dot;       ///< nv, of which r are used
    double *rows;              ///< nc
} hn_chart_jacobian;

/// Takes the memory from `arena`, once. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_chart_jacobian_prepare(hn_chart_jacobian *c, const hn_chart *chart,
                                                  hn_arena *arena);
/// Takes the derivatives at `here` of the chart with speeds v (nv), prepared if need be. Fails as
/// hn_accel_jacobian_at() and _prepare() do, told in chart->why.
HN_MUST_CHECK hn_status hn_chart_jacobian_at(hn_chart_jacobian *c, hn_chart *chart, hn_arena *arena,
                                             const double *v);
void hn_chart_jacobian_free(hn_chart_jacobian *c);
/// d(u_q', u')/d(u_q, u) of minimal coordinates, 2 r square, row-major.
void hn_chart_jacobian_minimal(hn_chart_jacobian *c, hn_chart *chart, double *jac);
/// d(q', u')/d(q, u), nv + r square, row-major; for mechanisms without balls.
void hn_chart_jacobian_speeds(hn_chart_jacobian *c, hn_chart *chart, double *jac);
void hn_chart_jacobian_add_cost(const hn_chart_jacobian *c, hn_cost *cost);

#endif
