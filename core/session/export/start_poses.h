// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_START_POSES_H
#define HN_SESSION_START_POSES_H
// The mechanism as it stands at the assembled start: where each body is, and what each joint of the
// spanning tree is made of, hinge by hinge and slide by slide, in world axes.

#include "import/frame.h"
#include "session/model/model.h"

#include <stdbool.h>

enum { HN_POSE_PARTS = 4 };

typedef enum hn_pose_kind { HN_POSE_HINGE, HN_POSE_SLIDE, HN_POSE_BALL, HN_POSE_FREE } hn_pose_kind;

/// One freedom of a joint: its kind, and the axis of the joint's frame that it goes along.
typedef struct hn_joint_step {
    hn_pose_kind kind;
    int axis; ///< 0 x, 1 y, 2 z
} hn_joint_step;

/// One freedom of a joint (all of them, for a ball or a free joint) between a body and its parent
/// in the tree.
typedef struct hn_pose_part {
    hn_pose_kind kind;
    int coordinate;        ///< of the scene; of a ball or free joint its first
    double at[3], axis[3]; ///< world [m], and unit; +axis is how the coordinate of the body grows
    double velocity[3];    ///< free: of the body's origin, world axes [m/s]
    double spin[3];        ///< ball and free: of the body against its parent, world axes [rad/s]
} hn_pose_part;

typedef struct hn_pose {
    hn_im_frame world;
    int parent; ///< body in the tree, or HN_GROUND
    int joint;  ///< that carries the body
    int n;      ///< parts; the first is next to the parent
    hn_pose_part part[HN_POSE_PARTS];
} hn_pose;

typedef struct hn_start_poses {
    const double *q, *v; ///< by coordinate of the scene; 0 for those of cut joints
    hn_pose *body;       ///< by body of the scene
} hn_start_poses;

/// Fills `out` from the assembled start of a scene of bodies; arrays live in `arena`.
/// Fails: HN_ERR_MEMORY; HN_ERR_UNSUPPORTED, when a free joint carries its parent.
HN_MUST_CHECK hn_status hn_start_poses_find(const hn_model *model, hn_arena *arena,
                                            hn_start_poses *out);
/// The pose of a body, or of the ground.
hn_im_frame hn_start_poses_world(const hn_start_poses *poses, int body);
/// Returns the motions of a joint's coordinates, in order from its parent; `n` gets their number.
const hn_joint_step *hn_joint_steps(hn_joint_type type, int *n);
/// Returns the frame of a joint in its parent (side 0) or in its child (side 1): z is its axis, x
/// its reference.
hn_im_frame hn_joint_side(const hn_joint *joint, int side);

#endif
