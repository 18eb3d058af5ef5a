// SPDX-License-Identifier: GPL-3.0-or-later
// Directions: axes, reference directions, normals.

#include "scene/reader.h"

#include <math.h>

bool hn_rd_direction(hn_reader *r, const cJSON *object, const char *key, double out[3]) {
    const cJSON *node = hn_rd_get(object, key);
    hn_quantity v[3];
    size_t mark = hn_rd_enter(r, key);
    bool ok = hn_rd_vector(r, node, v, HN_RD_CONST);
    if (ok) {
        // hypot-like scaling keeps 1e-200 and 1e200 alive
        double big = fmax(fabs(v[0].value), fmax(fabs(v[1].value), fabs(v[2].value))), length = 0;
        for (int k = 0; k < 3 && big > 0; k++) {
            out[k] = v[k].value / big;
            length += out[k] * out[k];
        }
        ok = big > 0 ? 1 : hn_rd_fault(r, "as in [0, 0, 1]", "a direction of length zero");
        for (int k = 0; k < 3 && ok; k++) {
            // an axis that is unit already keeps its digits
            out[k] = fabs(length * big * big - 1) < 1e-15 ? v[k].value : out[k] / sqrt(length);
        }
    }
    hn_rd_leave(r, mark);
    return ok;
}

void hn_rd_default_normal(const double axis[3], double ref[3]) {
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = fabs(axis[i]) < fabs(axis[k]) - 1e-12 ? i : k;
    }
    double length = sqrt(1 - axis[k] * axis[k]);
    for (int i = 0; i < 3; i++) {
        ref[i] = ((i == k) - axis[k] * axis[i]) / length;
    }
}

bool hn_rd_make_normal(hn_reader *r, const char *key, const double axis[3], double ref[3]) {
    double along = axis[0] * ref[0] + axis[1] * ref[1] + axis[2] * ref[2];
    if (fabs(along) > 1e-6) {
        return hn_rd_fault_at(r, key, NULL,
                              "the direction '%s' is not perpendicular to the axis (cosine %.3g)",
                              key, along);
    }
    for (int k = 0; k < 3; k++) {
        ref[k] -= along * axis[k];
    }
    return true;
}
