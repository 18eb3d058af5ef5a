// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_FOLLOW_H
#define HN_FORMULATIONS_CHART_FOLLOW_H
// Position solves that stay on their branch: the loops are closed from the tangent prediction at
// the last accepted state, and where the closed configuration is far from the prediction, the way
// there is followed in smaller steps.

#include "formulations/chart/chart.h"

/// Closes the loops at `point` for independent entries q_ind (r) at time t, on the branch of
/// `base`. q (nq) receives the closed configuration. `spare` is another point of the chart; it is
/// spoiled. Fails as hn_chart_close().
HN_MUST_CHECK hn_status hn_chart_follow(hn_chart *chart, hn_chart_point *point,
                                        hn_chart_point *spare, double t, const double *q_ind,
                                        double *q, double tol);
/// Returns whether a closed configuration q is so near to its prediction (nq each) that the branch
/// and the turns of the angles are in no doubt.
bool hn_chart_is_near(const hn_chart *chart, const double *predicted, const double *q);

#endif
