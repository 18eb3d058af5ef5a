// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/pivot_noise.h"

#include <math.h>

// noise per unit of the relative gap: measured over open loops of short and long links
static const double NOISE = 30;
// reached at a gap of a third of a per mille: larger pivots are real whatever the gap
static const double NOISE_MAX = 1e-2;

double hn_pivot_noise_of(double gap) {
    return fmin(NOISE * gap, NOISE_MAX);
}

double hn_pivot_noise_of_sides(double gap) {
    return fmin(NOISE * gap, 1);
}

double hn_pivot_noise_gap(const hn_system *sys, const hn_pivot_noise_terms *at, const double *v,
                          double *rate, double *size) {
    const hn_system_info info = hn_system_get_info(sys);
    double gap = 0, rates = 0, sizes = 0;
    for (int i = 0; i < info.nc; i++) {
        rate[i] = at->phi_t[i];
        size[i] = fabs(at->phi_t[i]);
    }
    for (int k = 0; k < at->n_J; k++) {
        const int i = at->row[k], j = at->col[k];
        const double entry = at->J ? at->J[(size_t)i * (size_t)info.nv + (size_t)j] : at->list[k];
        const double part = entry * v[j];
        rate[i] += part;
        size[i] = fmax(size[i], fabs(part));
    }
    for (int i = 0; i < info.nc; i++) {
        const double unit = hn_system_row_unit(sys, i);
        gap = fmax(gap, fabs(at->phi[i]) / unit);
        rates = fmax(rates, fabs(rate[i]) / unit);
        sizes = fmax(sizes, size[i] / unit);
    }
    return fmax(gap, sizes > 0 ? rates / sizes : 0);
}
