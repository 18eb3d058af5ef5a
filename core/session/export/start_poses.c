// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/start_poses.h"

#include "dynamics/compile/coordinates.h"
#include "linalg/small3.h"

#include <string.h>

/// The motions of a joint's coordinates, in their order (scene.h).
static const struct {
    int n;
    hn_joint_step step[HN_POSE_PARTS];
} STEPS[HN_JOINT_TYPE_COUNT] = {
    [HN_JOINT_REVOLUTE] = {1, {{HN_POSE_HINGE, 2}}},
    [HN_JOINT_PRISMATIC] = {1, {{HN_POSE_SLIDE, 2}}},
    [HN_JOINT_CYLINDRICAL] = {2, {{HN_POSE_HINGE, 2}, {HN_POSE_SLIDE, 2}}},
    [HN_JOINT_UNIVERSAL] = {2, {{HN_POSE_HINGE, 2}, {HN_POSE_HINGE, 0}}},
    [HN_JOINT_SPHERICAL] = {1, {{HN_POSE_BALL, 0}}},
    [HN_JOINT_PLANAR] = {3, {{HN_POSE_SLIDE, 0}, {HN_POSE_SLIDE, 1}, {HN_POSE_HINGE, 2}}},
    [HN_JOINT_FIXED] = {0, {{HN_POSE_HINGE, 0}}},
    [HN_JOINT_FREE] =
        {4, {{HN_POSE_SLIDE, 0}, {HN_POSE_SLIDE, 1}, {HN_POSE_SLIDE, 2}, {HN_POSE_BALL, 0}}},
};

const hn_joint_step *hn_joint_steps(hn_joint_type type, int *n) {
    *n = STEPS[type].n;
    return STEPS[type].step;
}

static hn_im_frame side_frame(const hn_quantity at[3], const double axis[3], const double ref[3]) {
    double y[3];
    hn_im_frame out;
    hn_num3_cross(axis, ref, y);
    for (int i = 0; i < 3; i++) {
        out.R[i][0] = ref[i];
        out.R[i][1] = y[i];
        out.R[i][2] = axis[i];
        out.p[i] = at[i].value;
    }
    return out;
}

hn_im_frame hn_joint_side(const hn_joint *j, int side) {
    return side ? side_frame(j->child_at, j->child_axis, j->child_ref)
                : side_frame(j->parent_at, j->parent_axis, j->parent_ref);
}

hn_im_frame hn_start_poses_world(const hn_start_poses *poses, int body) {
    return body == HN_GROUND ? hn_im_frame_unit() : poses->body[body].world;
}

/// The motion of one step, at the coordinate's value (three values for a ball).
static hn_im_frame motion(const hn_joint_step *s, const double *q) {
    hn_im_frame out = hn_im_frame_unit();
    double axis[3] = {0, 0, 0};
    if (s->kind == HN_POSE_SLIDE) {
        out.p[s->axis] = q[0];
    } else if (s->kind == HN_POSE_HINGE) {
        axis[s->axis] = 1;
        hn_im_rotation(axis, q[0], out.R);
    } else {
        // a rotation vector, too short for a direction where nothing is turned
        const double angle = hn_num3_norm(q);
        memcpy(axis, q, sizeof axis);
        if (hn_im_normalise(axis)) {
            hn_im_rotation(axis, angle, out.R);
        }
    }
    return out;
}

/// From the joint's frame in its parent to that in its child.
static hn_im_frame across(const hn_joint *j, const double *q) {
    hn_im_frame out = hn_im_frame_unit();
    for (int k = 0; k < STEPS[j->type].n; k++) {
        const hn_im_frame next = motion(&STEPS[j->type].step[k], q + j->coordinate + k);
        out = hn_im_frame_mul(&out, &next);
    }
    return out;
}

/// The parts of a joint from its parent to its child; `x` begins as its frame in the parent.
static void list_parts(const hn_joint *j, const hn_start_poses *poses, hn_im_frame x,
                       hn_pose *pose) {
    pose->n = STEPS[j->type].n;
    for (int k = 0; k < pose->n; k++) {
        const hn_joint_step *s = &STEPS[j->type].step[k];
        hn_pose_part *p = &pose->part[k];
        const int c = j->coordinate + k;
        *p = (hn_pose_part){.kind = s->kind, .coordinate = c};
        for (int i = 0; i < 3; i++) {
            p->at[i] = x.p[i];
            p->axis[i] = x.R[i][s->axis];
        }

        // spin of a ball is in the axes of the child
        const hn_im_frame next = motion(s, poses->q + c);
        x = hn_im_frame_mul(&x, &next);
        if (s->kind == HN_POSE_BALL) {
            hn_im_turn(&x, poses->v + c, p->spin);
        }
    }
}

/// Seen from the child the same freedoms come in the other order, and go the other way.
static void turn_round(hn_pose *pose) {
    hn_pose_part old[HN_POSE_PARTS];
    memcpy(old, pose->part, sizeof old);
    for (int k = 0; k < pose->n; k++) {
        pose->part[k] = old[pose->n - 1 - k];
        for (int i = 0; i < 3; i++) {
            pose->part[k].axis[i] = -pose->part[k].axis[i];
            pose->part[k].spin[i] = -pose->part[k].spin[i];
        }
    }
}

/// A free joint as one part: how the body's origin moves, and how it turns.
static void join_free(const hn_joint *j, const hn_start_poses *poses, hn_pose *pose) {
    hn_pose_part all = pose->part[HN_POSE_PARTS - 1];
    double arm[3], carried[3];
    for (int i = 0; i < 3; i++) {
        arm[i] = pose->world.p[i] - all.at[i];
    }
    hn_num3_cross(all.spin, arm, carried);
    for (int i = 0; i < 3; i++) {
        all.velocity[i] = carried[i];
        for (int k = 0; k < 3; k++) {
            all.velocity[i] += pose->part[k].axis[i] * poses->v[j->coordinate + k];
        }
    }
    all.kind = HN_POSE_FREE;
    all.coordinate = j->coordinate;
    pose->part[0] = all;
    pose->n = 1;
}

/// Places a body whose parent in the tree has been placed.
static hn_status place(const hn_scene *scene, hn_start_poses *poses, int body, bool reversed) {
    hn_pose *pose = &poses->body[body];
    const hn_joint *j = &scene->joints[pose->joint];
    const hn_im_frame from = hn_start_poses_world(poses, pose->parent);
    const hn_im_frame inner = hn_joint_side(j, reversed), outer = hn_joint_side(j, !reversed);
    hn_im_frame step_over = across(j, poses->q), start = hn_im_frame_mul(&from, &inner);
    if (reversed) {
        step_over = hn_im_frame_inverse(&step_over);
    }

    // over the joint, and back along the body's side of it
    const hn_im_frame end = hn_im_frame_mul(&start, &step_over);
    const hn_im_frame back = hn_im_frame_inverse(&outer);
    pose->world = hn_im_frame_mul(&end, &back);
    list_parts(j, poses, reversed ? end : start, pose);
    if (reversed) {
        turn_round(pose);
    }
    if (j->type == HN_JOINT_FREE && (reversed || pose->parent != HN_GROUND)) {
        return HN_ERR_UNSUPPORTED;
    }
    if (j->type == HN_JOINT_FREE) {
        join_free(j, poses, pose);
    }
    return HN_OK;
}

/// Positions and rates of the tree's coordinates, by coordinate of the scene.
static hn_status read_start(const hn_model *model, hn_arena *arena, hn_start_poses *out) {
    const hn_scene *scene = hn_model_scene(model);
    const hn_system *sys = hn_model_system(model);
    const int n = hn_system_get_info(sys).n_user;
    const size_t room = (size_t)scene->n_coordinates + 1;
    double *q = hn_arena_doubles(arena, room), *v = hn_arena_doubles(arena, room);
    double *user_q = hn_arena_doubles(arena, (size_t)n + 1);
    double *user_v = hn_arena_doubles(arena, (size_t)n + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // coordinates of cut joints stay 0
    memset(q, 0, room * sizeof *q);
    memset(v, 0, room * sizeof *v);
    hn_system_to_user(sys, hn_model_q(model), user_q);
    hn_system_rates_to_user(sys, hn_model_v(model), user_v);
    for (int i = 0; i < n; i++) {
        q[hn_system_user_coordinate(sys, i)] = user_q[i];
        v[hn_system_user_coordinate(sys, i)] = user_v[i];
    }
    out->q = q;
    out->v = v;
    return HN_OK;
}

hn_status hn_start_poses_find(const hn_model *model, hn_arena *arena, hn_start_poses *out) {
    const hn_scene *scene = hn_model_scene(model);
    const hn_system *sys = hn_model_system(model);
    bool *placed = hn_arena_get(arena, (size_t)scene->n_bodies + 1);
    HN_TRY(read_start(model, arena, out));
    out->body = hn_arena_get(arena, ((size_t)scene->n_bodies + 1) * sizeof *out->body);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // which joint carries each, from which side
    memset(placed, 0, ((size_t)scene->n_bodies + 1) * sizeof *placed);
    for (int i = 0; i < scene->n_bodies; i++) {
        const int joint = hn_system_tree_joint(sys, i);
        const hn_joint *j = &scene->joints[joint];
        out->body[i] = (hn_pose){.joint = joint, .parent = j->child == i ? j->parent : j->child};
    }

    // outwards from the ground, round after round
    for (int left = scene->n_bodies, made = 1; left > 0 && made;) {
        made = 0;
        for (int i = 0; i < scene->n_bodies; i++) {
            const int parent = out->body[i].parent;
            if (!placed[i] && (parent == HN_GROUND || placed[parent])) {
                HN_TRY(place(scene, out, i, scene->joints[out->body[i].joint].child != i));
                placed[i] = true;
                made = 1;
                left--;
            }
        }
    }
    return HN_OK;
}
