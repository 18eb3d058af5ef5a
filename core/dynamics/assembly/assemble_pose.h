// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_POSE_H
#define HN_DYNAMICS_ASSEMBLE_POSE_H
// Poses of bodies as numbers, straight from the scene, for what the closure rows do not say: which
// way round a loop is closed, and how long the sides of a loop are.

#include "dynamics/assembly/assemble_state.h"

#include <stdbool.h>

typedef struct hn_body_pose {
    double R[3][3]; ///< body to world
    double p[3];    ///< world position of the body's origin
} hn_body_pose;

/// The pose of a body at s->x, by its tree joints down to the ground.
hn_body_pose hn_assemble_body_pose(const hn_assembler *s, int body);
/// World position of a joint as seen from one of its two bodies.
void hn_assemble_joint_position(const hn_assembler *s, int joint, int body, double out[3]);
/// Returns the first loop that is closed at s->x the wrong way round, or -1. Its rows also hold
/// with the axis (or the reference direction) of one half opposed to the other's, which is another
/// mechanism. Loops whose axes cannot tilt are never flipped.
int hn_assemble_flipped(const hn_assembler *s);

#endif
