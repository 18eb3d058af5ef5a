// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MJCF_WRITER_H
#define HN_SESSION_MJCF_WRITER_H
// The text of an MJCF model, element by element; mechanism.h says what becomes what.

#include "session/export/start_poses.h"

#include <stdbool.h>

/// All springs and dampers of one coordinate: stiffness, stiffness times rest value, damping.
typedef struct hn_mjcf_spring {
    double stiffness, pull, damping;
} hn_mjcf_spring;

typedef struct hn_mjcf {
    const hn_model *model;
    const hn_scene *scene;
    hn_start_poses poses;
    hn_mjcf_spring *springs; ///< by coordinate
    bool *is_drive;          ///< by load: it becomes an actuator
    bool *is_gear;           ///< by constraint: it becomes an equality of joints
    bool is_planar;          ///< everything moves across one direction
    hn_strbuf *out, *left_out;
    hn_strbuf qpos, qvel; ///< of the keyframe, in the order of the joints
} hn_mjcf;

/// Writes the whole model. Failures of memory show in `out`.
void hn_mjcf_write(hn_mjcf *m);

#endif
