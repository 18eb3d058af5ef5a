// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart_follow.h"

#include <math.h>
#include <string.h>

// Newton's method from a prediction finds the branch of the prediction only where the two are
// close. A step of a driven mechanism without degrees of freedom has no error that would bound it,
// and a long step of any other may arrive at another branch of the loops, or a turn away in an
// angle.
//
// [rad], or of the characteristic length: a correction of the tangent prediction below this leaves
// an angle's turn and the branch in no doubt; steps of ordinary length correct by about 1e-3
#define FAR 0.25
enum { MOST_PIECES = 64 };

// largest correction of a coordinate of its own, in radians or characteristic lengths
static double correction(const hn_chart *chart, const double *predicted, const double *q) {
    double largest = 0;
    for (int i = 0; i < chart->nv; i++) {
        const int at = chart->at[i];
        if (at >= 0) {
            largest = fmax(largest, fabs(q[at] - predicted[at]) / chart->scale[i]);
        }
    }
    return largest;
}

// from `base` to (t, q_ind) in n pieces; *worst receives the largest correction of a piece
static hn_status follow_in(hn_chart *chart, hn_chart_point *point, hn_chart_point *spare, int n,
                           double t, const double *q_ind, double *q, double tol, double *worst) {
    const hn_chart_point *from = &chart->base;
    double *part = chart->follow_ind, *predicted = chart->follow_q;
    *worst = 0;

    // the two points take turns, so that the last piece ends at `point`
    for (int i = 1; i <= n; i++) {
        hn_chart_point *to = (n - i) % 2 == 0 ? point : spare;
        const double share = (double)i / n, s = chart->base.t + share * (t - chart->base.t);
        for (int j = 0; j < chart->r; j++) {
            const double start = chart->base.q[chart->at[chart->ind[j]]];
            part[j] = i == n ? q_ind[j] : start + share * (q_ind[j] - start);
        }
        hn_chart_predict_from(chart, from, i == n ? t : s, part, predicted);
        memcpy(q, predicted, (size_t)chart->nq * sizeof *q);
        HN_TRY(hn_chart_close(chart, to, i == n ? t : s, q, tol));
        *worst = fmax(*worst, correction(chart, predicted, q));
        from = to;
    }
    return HN_OK;
}

bool hn_chart_is_near(const hn_chart *chart, const double *predicted, const double *q) {
    return correction(chart, predicted, q) <= FAR;
}

hn_status hn_chart_follow(hn_chart *chart, hn_chart_point *point, hn_chart_point *spare, double t,
                          const double *q_ind, double *q, double tol) {
    double worst = 0;
    hn_status status = follow_in(chart, point, spare, 1, t, q_ind, q, tol, &worst);

    // smaller pieces until each stays near its prediction; without any, the first failure stands
    for (int n = 2; n <= MOST_PIECES && !(status == HN_OK && worst <= FAR); n *= 2) {
        if (!chart->base.valid || (status != HN_OK && status != HN_ERR_CHART)) {
            break;
        }
        status = follow_in(chart, point, spare, n, t, q_ind, q, tol, &worst);
        spare->valid = 0;
    }
    return status;
}
