// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SCENE_JOINT_FREEDOMS_H
#define HN_SCENE_JOINT_FREEDOMS_H
// The degrees of freedom of each type of joint.

#include "scene/scene.h"

enum { HN_JOINT_FREEDOMS = 6 }; // a joint has no more

/// One degree of freedom of the child against the parent.
typedef struct hn_freedom {
    const char *suffix; ///< what its coordinate's name has behind that of the joint: "_way", or ""
    hn_unit_kind kind;
    int turn; ///< 0, 1, 2: entry of a rotation vector, -1: a coordinate of its own
} hn_freedom;

/// Returns the degrees of freedom of a type in the order of its coordinates (scene.h lists them);
/// `n` gets their number, 0 for a fixed joint.
const hn_freedom *hn_joint_freedoms(hn_joint_type type, int *n);

#endif
