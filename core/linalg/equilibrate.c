// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/equilibrate.h"

#include <math.h>
#include <stddef.h>

static const double MASSLESS = 1e-14; // of the heaviest: rounding of sums that cancel is below it

hn_status hn_heaviest_mass(int nv, const double *M, double *heaviest) {
    double most = 0;
    for (int j = 0; j < nv; j++) {
        const double m = M[(size_t)j * (size_t)nv + (size_t)j];
        if (m < 0) {
            return HN_ERR_NOT_SPD;
        }
        most = fmax(most, m);
    }
    *heaviest = most;
    return HN_OK;
}

bool hn_is_massless(double m, double heaviest) {
    return !(m > MASSLESS * heaviest);
}

double hn_column_size(int nv, int nc, const double *J, int j) {
    double size = 0;
    for (int i = 0; i < nc; i++) {
        size = fmax(size, fabs(J[(size_t)i * (size_t)nv + (size_t)j]));
    }
    return size;
}
