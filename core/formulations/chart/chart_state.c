// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart_state.h"

#include "dynamics/compile/coordinates.h"

#include <stdio.h>

hn_status hn_chart_fail(hn_chart *chart, hn_status status, double t, const double *q,
                        const char *what) {
    const int i = chart->r > 0 ? chart->ind[0] : 0;
    if (i < hn_system_get_info(chart->sys).n_user && chart->at[i] >= 0) {
        const hn_scene *scene = hn_system_scene(chart->sys);
        const char *name = scene->coordinates[hn_system_user_coordinate(chart->sys, i)].name;
        snprintf(chart->why, sizeof chart->why, "%s = %.6g at t = %.6g s: %s", name,
                 q[chart->at[i]], t, what);
    } else {
        snprintf(chart->why, sizeof chart->why, "at t = %.6g s: %s", t, what);
    }
    return status;
}
