// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/assemble_pose.h"

#include "dynamics/compile/loops.h"
#include "dynamics/compile/quaternion.h"
#include "dynamics/compile/tree.h"
#include "linalg/dense.h"
#include "linalg/small3.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// ---- poses of bodies, straight from the scene ----

/// Joint frame in body axes: columns ref, axis x ref, axis.
static void joint_frame(const double axis[3], const double ref[3], double out[3][3]) {
    double side[3];
    hn_num3_cross(axis, ref, side);
    for (int i = 0; i < 3; i++) {
        out[i][0] = ref[i];
        out[i][1] = side[i];
        out[i][2] = axis[i];
    }
}

static void place(const hn_quantity at[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = at[i].value;
    }
}

/// Turn by one primitive of a joint at its coordinates x, in the joint's axes, and the way it
/// moves.
static void primitive_motion(const hn_primitive *primitive, const double *x, double turn[3][3],
                             double way[3]) {
    const int i = (primitive->along + 1) % 3, j = (primitive->along + 2) % 3;

    if (primitive->type == HN_JOINT_REVOLUTE) {
        turn[i][i] = turn[j][j] = cos(x[0]);
        turn[j][i] = sin(x[0]);
        turn[i][j] = -turn[j][i];
    } else if (primitive->type == HN_JOINT_PRISMATIC) {
        way[primitive->along] = x[0];
    } else if (primitive->type == HN_JOINT_SPHERICAL) {
        for (int k = 0; k < 3; k++) { // column k: the unit vector k turned
            double q[4], back[4], e[4] = {0}, out[4];
            hn_quat_exp(x, q);
            hn_quat_exp((double[3]){-x[0], -x[1], -x[2]}, back);
            e[k + 1] = 1;
            hn_quat_mul(q, e, out);
            hn_quat_mul(out, back, out);
            for (int r = 0; r < 3; r++) {
                turn[r][k] = out[r + 1];
            }
        }
    }
}

/// Rotation and shift from the joint's child to its parent at coordinate values x: p_parent = R
/// p_child + shift.
static void joint_transform(const hn_joint *joint, const double *x, hn_body_pose *out) {
    double B[3][3], C[3][3], so_far[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, slid[3] = {0};
    const hn_primitive *chain;
    const int n = hn_joint_primitives(joint->type, &chain);
    joint_frame(joint->parent_axis, joint->parent_ref, B);
    joint_frame(joint->child_axis, joint->child_ref, C);

    // primitive by primitive, in the joint's axes
    for (int k = 0; k < n; k++) {
        double turn[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, way[3] = {0, 0, 0}, gone[3];
        primitive_motion(&chain[k], x + chain[k].part, turn, way);
        hn_num3_apply(so_far, way, gone);
        hn_axpy(3, 1, gone, slid);
        hn_num3_mul(so_far, turn, so_far);
    }

    // from the child's axes through the joint's to the parent's
    hn_num3_transpose(C, C);
    hn_num3_mul(B, so_far, so_far);
    hn_num3_mul(so_far, C, out->R);

    // and the shift that puts the two places together
    double at_parent[3], at_child[3], arm[3], gone[3];
    place(joint->parent_at, at_parent);
    place(joint->child_at, at_child);
    hn_num3_apply(out->R, at_child, arm);
    hn_num3_apply(B, slid, gone);
    for (int i = 0; i < 3; i++) {
        out->p[i] = at_parent[i] + gone[i] - arm[i];
    }
}

static void coordinate_values(const hn_assembler *s, const hn_joint *joint, double x[6]) {
    for (int k = 0; k < s->n; k++) {
        const int part = hn_system_user_coordinate(s->sys, k) - joint->coordinate;
        if (joint->coordinate >= 0 && part >= 0 && part < joint->n_coordinates) {
            x[part] = s->x[k];
        }
    }
}

/// Pose of a body by its tree joints down to the ground. The tree is shallow and this runs once, on
/// failure.
hn_body_pose hn_assemble_body_pose(const hn_assembler *s, int body) {
    hn_body_pose at = {.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    while (body != HN_GROUND) {
        const hn_joint *joint = &s->scene->joints[hn_system_tree_joint(s->sys, body)];
        hn_body_pose step, next;
        double x[6] = {0};
        coordinate_values(s, joint, x);
        joint_transform(joint, x, &step);

        if (joint->child != body) { // the tree runs through this joint backwards
            hn_body_pose inverse;
            hn_num3_transpose(step.R, inverse.R);
            hn_num3_apply(inverse.R, step.p, inverse.p);
            for (int i = 0; i < 3; i++) {
                inverse.p[i] = -inverse.p[i];
            }
            step = inverse;
        }

        // composed with what is known already
        hn_num3_mul(step.R, at.R, next.R);
        hn_num3_apply(step.R, at.p, next.p);
        for (int i = 0; i < 3; i++) {
            next.p[i] += step.p[i];
        }
        at = next;
        body = joint->child == body ? joint->parent : joint->child;
    }
    return at;
}

/// World position of a joint as seen from one of its two bodies.
void hn_assemble_joint_position(const hn_assembler *s, int joint_index, int body, double out[3]) {
    const hn_joint *joint = &s->scene->joints[joint_index];
    double local[3];
    place(joint->parent == body ? joint->parent_at : joint->child_at, local);
    hn_body_pose at = hn_assemble_body_pose(s, body);
    hn_num3_apply(at.R, local, out);
    for (int i = 0; i < 3; i++) {
        out[i] += at.p[i];
    }
}

// ---- loops closed the wrong way round ----

static void world_direction(const hn_assembler *s, int body, const double v[3], double out[3]) {
    hn_body_pose at = hn_assemble_body_pose(s, body);
    hn_num3_apply(at.R, v, out);
}

/// Returns whether directions of the two halves that should agree are opposed.
static bool is_opposed(const hn_assembler *s, const hn_joint *joint) {
    const hn_joint_ties ties = hn_joint_ties_of(joint->type);
    double a[3], b[3];
    bool opposed = false;
    if (ties.axes) {
        world_direction(s, joint->parent, joint->parent_axis, a);
        world_direction(s, joint->child, joint->child_axis, b);
        opposed |= hn_dot(3, a, b) < 0;
    }
    if (ties.refs) {
        world_direction(s, joint->parent, joint->parent_ref, a);
        world_direction(s, joint->child, joint->child_ref, b);
        opposed |= hn_dot(3, a, b) < 0;
    }
    return opposed;
}

int hn_assemble_flipped(const hn_assembler *s) {
    for (int i = 0; i < s->nc && !s->scene->is_lagrangian; i++) {
        const int loop = hn_system_row_loop(s->sys, i), joint = hn_system_loop_joint(s->sys, loop);
        if (joint < 0 || hn_system_row_is_length(s->sys, i) ||
            (i > 0 && hn_system_row_loop(s->sys, i - 1) == loop &&
             !hn_system_row_is_length(s->sys, i - 1))) {
            continue; // once per loop, at its first row that is an angle
        }
        if (is_opposed(s, &s->scene->joints[joint])) {
            return loop;
        }
    }
    return -1;
}
