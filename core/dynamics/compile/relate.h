// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_RELATE_H
#define HN_DYNAMICS_RELATE_H
// Motion of two points relative to a common ancestor of their links, in one frame of that
// ancestor's: closures and loads are written with it. relate.c says which frame.

#include "dynamics/compile/mech.h"

#include <stdbool.h>

typedef struct hn_lever {
    int coordinate;
    bool is_slide;
    int group;
    int open;      ///< still turns whatever comes: at the end of a path, the end link
    hn_vec3 axis;  ///< of the turn or slide
    hn_vec3 lever; ///< sum of the arms it turns
} hn_lever;

/// Motion of one link and of a point on it, relative to a common ancestor, in one frame of that
/// ancestor's.
typedef struct hn_reach {
    hn_vec3 pos, acc; ///< acc: at zero u-dot
    hn_mat3 U;        ///< E(link) to the frame
    hn_vec3 w;        ///< angular velocity in the frame
    hn_mat3 B;
    int n;
    hn_lever *levers;
} hn_reach;

typedef struct hn_relative {
    int common; ///< link both are seen from
    hn_reach a, b;
    int aligned;           ///< the frame's axes are the world's (seen from the ground)
    double to_world[3][3]; ///< frame to world, where `common` does not rotate
} hn_relative;

/// Point `arm_a` (in E) of link a and point `arm_b` of link b. Memory from the system's arena.
HN_MUST_CHECK hn_status hn_mech_relate(hn_mech *m, int common, int a, hn_vec3 arm_a, int b,
                                       hn_vec3 arm_b, hn_relative *out);
/// d pos / d u of one lever.
hn_vec3 hn_lever_coefficient(hn_graph *g, const hn_lever *lever);

#endif
