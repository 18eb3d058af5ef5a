// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/picture_angles.h"

#include <math.h>
#include <stdbool.h>

/// The bar of the joint's second body that ends at the joint: *pivot there, *end at its other end.
static bool find_bar(const hn_scene *s, const hn_joint *joint, int *pivot, int *end) {
    for (int i = 0; i < s->n_shapes; i++) {
        const hn_shape *bar = &s->shapes[i];
        const int ends[2] = {bar->p, bar->q};
        for (int k = 0; k < 2 && bar->kind == HN_SHAPE_BAR && bar->body == joint->child; k++) {
            const hn_point *point = &s->points[ends[k]];
            bool here = point->body == joint->child;
            for (int j = 0; j < 3; j++) {
                here = here && point->at[j].value == joint->child_at[j].value;
            }
            if (here) {
                *pivot = ends[k];
                *end = ends[1 - k];
                return true;
            }
        }
    }
    return false;
}

int hn_picture_angles(const hn_model *model, const double *q, hn_snapshot_angle *out) {
    const hn_scene *s = hn_model_scene(model);
    const hn_system *sys = hn_model_system(model);
    int n = 0;
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        const hn_coordinate *x = &s->coordinates[hn_system_user_coordinate(sys, i)];
        const hn_joint *joint = x->joint >= 0 ? &s->joints[x->joint] : NULL;
        if (!joint || joint->type != HN_JOINT_REVOLUTE || joint->is_formal) {
            continue;
        }
        const double axis = joint->parent_axis[2];
        hn_snapshot_angle angle = {.value = axis > 0 ? q[i] : -q[i], .name = x->name};
        if (fabs(axis) == 1 && isfinite(q[i]) && find_bar(s, joint, &angle.pivot, &angle.end)) {
            out[n++] = angle;
        }
    }
    return n;
}
