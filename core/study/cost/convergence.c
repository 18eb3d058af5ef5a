// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/convergence.h"

#include <math.h>

double hn_fit_order(int n, const double *x, const double *y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    int used = 0;
    for (int i = 0; i < n; i++) {
        if (!(x[i] > 0) || !(y[i] > 0) || !isfinite(x[i]) || !isfinite(y[i])) {
            continue;
        }
        const double a = log(x[i]), b = log(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
        used++;
    }
    const double spread = used * sxx - sx * sx;
    return used >= 2 && spread > 0 ? (used * sxy - sx * sy) / spread : nan("");
}
