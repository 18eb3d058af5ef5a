// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/caption.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const double SAME_LENGTH = 1e-9; ///< relative

/// Distance between the two joints of a body (or of the ground); 0 unless it has exactly two.
static double link_length(const hn_scene *scene, int body) {
    double at[2][3] = {{0}};
    int n = 0;
    for (int j = 0; j < scene->n_joints; j++) {
        const hn_joint *joint = &scene->joints[j];
        const hn_quantity *p = joint->parent == body  ? joint->parent_at
                               : joint->child == body ? joint->child_at
                                                      : NULL;
        if (!p) {
            continue;
        }
        if (n == 2) {
            return 0;
        }
        for (int k = 0; k < 3; k++) {
            at[n][k] = p[k].value;
        }
        n++;
    }
    return n == 2 ? hypot(hypot(at[1][0] - at[0][0], at[1][1] - at[0][1]), at[1][2] - at[0][2]) : 0;
}

static int other_body(const hn_joint *joint, int body) {
    return joint->parent == body ? joint->child : joint->parent;
}

/// Both of the joint's axes stand along z, the axis of a plane linkage.
static bool turns_in_the_plane(const hn_joint *j) {
    return j->type == HN_JOINT_REVOLUTE && j->parent_axis[0] == 0 && j->parent_axis[1] == 0 &&
           j->child_axis[0] == 0 && j->child_axis[1] == 0;
}

/// Lengths of a closed plane chain of three bodies and four revolute joints: ground, input,
/// coupler, output. 0 if it is none: Grashof's rule holds in the plane only.
static bool four_bar_lengths(const hn_scene *scene, double out[4]) {
    if (scene->is_lagrangian || scene->n_bodies != 3 || scene->n_joints != 4) {
        return false;
    }

    // follow the joints from the ground, round the loop
    int chain[4] = {HN_GROUND, HN_GROUND, HN_GROUND, HN_GROUND}, n = 1, last = -1;
    for (int step = 0; step < 4; step++) {
        int found = 0;
        for (int j = 0; j < 4 && !found; j++) {
            const hn_joint *joint = &scene->joints[j];
            if (!turns_in_the_plane(joint)) {
                return false;
            }
            int here = chain[n - 1];
            if (j != last && (joint->parent == here || joint->child == here)) {
                int next = other_body(joint, here);
                found = 1;
                last = j;
                if (n < 4) {
                    chain[n++] = next;
                }
            }
        }
        if (!found) {
            return false;
        }
    }

    // every link needs a length, and no body may occur twice
    for (int i = 0; i < 4; i++) {
        out[i] = link_length(scene, chain[i]);
        if (!(out[i] > 0)) {
            return false;
        }
    }
    return chain[1] != chain[2] && chain[2] != chain[3] && chain[1] != chain[3];
}

/// Grashof's rule for ground g, input a, coupler h, output b.
static const char *four_bar_kind(const double l[4]) {
    int shortest = 0;
    double largest = 0, sum = 0;
    for (int i = 0; i < 4; i++) {
        shortest = l[i] < l[shortest] ? i : shortest;
        largest = fmax(largest, l[i]);
        sum += l[i];
    }
    if (2 * largest > (1 + SAME_LENGTH) * sum) {
        return "links that cannot close";
    }
    double excess = 2 * (l[shortest] + largest) - sum;
    if (fabs(excess) < SAME_LENGTH * sum) {
        int parallel =
            fabs(l[0] - l[2]) < SAME_LENGTH * sum && fabs(l[1] - l[3]) < SAME_LENGTH * sum;
        return parallel ? "change-point parallelogram" : "change-point four-bar";
    }
    if (excess > 0) {
        return "triple-rocker";
    }
    static const char *const kinds[4] = {"double-crank", "crank-rocker", "double-rocker",
                                         "rocker-crank"};
    return kinds[shortest];
}

void hn_model_caption(const hn_model *model, char *out, size_t size) {
    const hn_assembly *a = hn_model_assembly(model);
    hn_system_info info = hn_system_get_info(hn_model_system(model));
    double lengths[4];
    const char *kind =
        four_bar_lengths(hn_model_scene(model), lengths) ? four_bar_kind(lengths) : NULL;
    int n = snprintf(out, size, "%s%s%d degree%s of freedom", kind ? kind : "", kind ? ", " : "",
                     a->freedoms, a->freedoms == 1 ? "" : "s");
    char redundant[32] = "";
    if (a->redundant > 0) {
        snprintf(redundant, sizeof redundant, ", %d redundant", a->redundant);
    }
    if (info.nc > 0 && n > 0 && (size_t)n < size) {
        snprintf(out + n, size - (size_t)n, " (%d \xe2\x88\x92 %d independent constraint%s%s)",
                 info.nv, a->rank, a->rank == 1 ? "" : "s", redundant);
    }
}
