// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_CHOICE_H
#define HN_FORMULATIONS_CHART_CHOICE_H
// The choice of the dependent and independent columns of a chart, and whether it still serves.

#include "formulations/chart/chart_state.h"

#include <stdbool.h>

/// A column that must be independent: its number, or
enum {
    /// the actuated coordinates and then the first ones, as long as |det J_d| is at least
    /// HN_CHART_TAU times the best found by pivoting, otherwise the pivots decide
    HN_CHART_PREFERRED = -1,
    /// when an earlier choice has become poor: columns change places while |det J_d| grows
    HN_CHART_BEST = -2
};
/// Chooses dependent and independent columns at (t, q). Fails with HN_ERR_CHART when column `first`
/// cannot be independent or the rank differs from the one of an earlier choice, HN_ERR_UNSUPPORTED
/// when the turning of a ball would have to be independent (plain_only).
HN_MUST_CHECK hn_status hn_chart_choose(hn_chart *chart, double t, const double *q, int first);
/// Chooses better columns at `base`, where a step from it has met the end of the present choice.
/// Fails: HN_ERR_CHART, with nothing changed, where the present choice is the best one; otherwise
/// as hn_chart_choose().
HN_MUST_CHECK hn_status hn_chart_choose_other(hn_chart *chart);
/// The end of the chart was passed: HN_ERR_CHART with `what`; where nothing but the turning of a
/// ball could have taken over since `base` (plain_only), HN_ERR_UNSUPPORTED and the ball's name,
/// because a shorter step changes nothing about that.
hn_status hn_chart_fail_end(hn_chart *chart, double t, const double *q, const char *what);
/// Returns whether changing one dependent column for an independent one would make |det J_d| at
/// `here` larger by more than 1 / tau, and at least double it, or when the chart nears its end and
/// another is better. With one freedom this compares with the best choice there is. h    size of
/// the last step [s] tau  0: never
bool hn_chart_is_poor(hn_chart *chart, double h, double tau);
/// Says whether det J_d, which falls as it did in the last step, vanishes within two more steps of
/// size h [s].
bool hn_chart_nears_end(const hn_chart *chart, double h);
/// Returns whether all of J has full row rank nearby; for telling a dead point of the chart from a
/// singular pose.
bool hn_chart_has_full_rank(hn_chart *chart, double t, const double *q);

#endif
