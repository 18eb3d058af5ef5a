// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/joint_freedoms.h"

static const struct {
    int n;
    hn_freedom of[HN_JOINT_FREEDOMS];
} FREEDOMS[HN_JOINT_TYPE_COUNT] = {
    [HN_JOINT_REVOLUTE] = {1, {{"", HN_ANGLE, -1}}},
    [HN_JOINT_PRISMATIC] = {1, {{"", HN_LENGTH, -1}}},
    [HN_JOINT_CYLINDRICAL] = {2, {{"_angle", HN_ANGLE, -1}, {"_way", HN_LENGTH, -1}}},
    [HN_JOINT_UNIVERSAL] = {2, {{"_1", HN_ANGLE, -1}, {"_2", HN_ANGLE, -1}}},
    [HN_JOINT_SPHERICAL] = {3, {{"_rx", HN_ANGLE, 0}, {"_ry", HN_ANGLE, 1}, {"_rz", HN_ANGLE, 2}}},
    [HN_JOINT_PLANAR] = {3,
                         {{"_x", HN_LENGTH, -1}, {"_y", HN_LENGTH, -1}, {"_angle", HN_ANGLE, -1}}},
    [HN_JOINT_FIXED] = {0, {{NULL, HN_OTHER, -1}}},
    [HN_JOINT_FREE] = {6,
                       {{"_x", HN_LENGTH, -1},
                        {"_y", HN_LENGTH, -1},
                        {"_z", HN_LENGTH, -1},
                        {"_rx", HN_ANGLE, 0},
                        {"_ry", HN_ANGLE, 1},
                        {"_rz", HN_ANGLE, 2}}},
};

const hn_freedom *hn_joint_freedoms(hn_joint_type type, int *n) {
    *n = FREEDOMS[type].n;
    return FREEDOMS[type].of;
}
