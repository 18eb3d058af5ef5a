// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/unit_scales.h"

#include "dynamics/compile/coordinates.h"

#include <math.h>

void hn_unit_scales(const hn_system *sys, const double *mass, int apart, double *scale) {
    const hn_scene *scene = hn_system_scene(sys);
    const int nv = hn_system_get_info(sys).nv, n_user = hn_system_get_info(sys).n_user;
    const double length = hn_system_length(sys);
    for (int j = 0; j < nv; j++) {
        const hn_unit_kind kind =
            j < n_user ? scene->coordinates[hn_system_user_coordinate(sys, j)].kind : HN_OTHER;
        const double own = mass[(size_t)j * (size_t)apart];
        // a massless coordinate keeps its own unit
        const double by_mass = own > 0 ? 1 / sqrt(own) : 1;
        scale[j] = kind == HN_ANGLE ? 1 : kind == HN_LENGTH ? length : by_mass;
    }
}
