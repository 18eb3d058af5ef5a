// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_DEPENDENT_H
#define HN_FORMULATIONS_CHART_DEPENDENT_H
// The dependent columns of a chart at one configuration: factor of J_d, basis and volume. A square
// J_d is factored sparse, others by dense QR.

#include "formulations/chart/chart_state.h"

#include <stdbool.h>

/// Factors J_d at the point, for hn_chart_locate() and hn_chart_close(). Returns false when it is
/// singular, or too near to that for this chart.
bool hn_chart_factor(hn_chart *chart, hn_chart_point *point);
/// x (rank, in the scaled columns) <- J_d^-1 b, b (nc) overwritten.
void hn_chart_solve_dependent(hn_chart *chart, const hn_chart_point *point, double *b, double *x);
/// N and s from the factor.
void hn_chart_make_basis(hn_chart *chart, hn_chart_point *point);
double hn_chart_smallest_pivot(const hn_chart *chart, const hn_chart_point *point);
double hn_chart_log_volume(const hn_chart *chart, const hn_chart_point *point);
/// Sets the entries of J_d for a choice in dep and ind.
void hn_chart_set_columns(hn_chart *chart);
/// Returns how |det J_d| would change if dependent column k (of dep) and independent column j (of
/// ind) changed places [-].
double hn_chart_exchange(const hn_chart *chart, const hn_chart_point *point, int k, int j);
/// |det J_d| at `here`, relative to where the chart was chosen.
double hn_chart_volume(const hn_chart *chart);

#endif
