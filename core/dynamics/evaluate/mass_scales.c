// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/mass_scales.h"

#include "dynamics/compile/coordinates.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double MASSLESS = 1e-14; // of the heaviest: rounding of sums that cancel is below it

/// The length of the mechanism [m] for a velocity that is one, else 1.
static double unit_of(const hn_system *sys, int k) {
    const hn_scene *scene = hn_system_scene(sys);
    const bool is_length = k < hn_system_get_info(sys).n_user &&
                           scene->coordinates[hn_system_user_coordinate(sys, k)].kind == HN_LENGTH;
    return is_length ? hn_system_length(sys) : 1;
}

void hn_mass_scales(const hn_system *sys, const hn_eval *eval, double *d) {
    const int nv = hn_system_get_info(sys).nv;
    const double *M = hn_eval_list(eval, HN_TERM_M);
    const int *row, *col, n = hn_eval_pattern(eval, HN_TERM_M, &row, &col);
    double heaviest = 0;
    memset(d, 0, (size_t)nv * sizeof *d);
    for (int k = 0; k < n; k++) {
        if (row[k] == col[k]) {
            const double unit = unit_of(sys, row[k]);
            d[row[k]] = M[k] * unit * unit;
            heaviest = fmax(heaviest, d[row[k]]);
        }
    }
    for (int k = 0; k < nv; k++) {
        const double mass = d[k] > MASSLESS * heaviest ? d[k] : heaviest > 0 ? heaviest : 1;
        d[k] = unit_of(sys, k) / sqrt(mass);
    }
}
