// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PICTURE_MOMENT_H
#define HN_SESSION_PICTURE_MOMENT_H
// One moment of a picture: the poses that several methods have reached, the lines that points have
// passed on the way, and the forces in the joints.

#include "base/arena.h"
#include "render/snapshot.h"
#include "session/compare/comparison.h"
#include "session/compare/picture.h"

enum { HN_PICTURE_NOTE = 240 };

typedef struct hn_picture_moment {
    const hn_model *model;
    const hn_picture_request *request;
    double time;                               ///< [s]; NaN: a pose that was given
    double reached[HN_COMPARISON_MAX_METHODS]; ///< [s] by each method; `time`, or before it
    hn_arena *arena;
    hn_comparison *comparison;
    int n_poses;
    hn_snapshot_pose poses[HN_COMPARISON_MAX_METHODS];
    char names[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    char notes[HN_COMPARISON_MAX_METHODS][HN_PICTURE_NOTE];
    double *points; ///< 3 n_points per pose
    int n_traces, trace_points[HN_PICTURE_TRACES];
    const char *trace_names[HN_PICTURE_TRACES];
    int n_loads;
    hn_snapshot_load *loads; ///< forces in the joints of the first method
    int n_angles;
    hn_snapshot_angle *angles; ///< of the first pose, where dimensions are asked for
} hn_picture_moment;

/// Runs the methods to `time`, or takes the pose that the request gives. *ended becomes the status
/// of the first method that ended early. hn_picture_moment_reset() in any case.
/// Fails: HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_picture_moment_make(hn_picture_moment *p, const hn_model *model,
                                               const hn_picture_request *request, double time,
                                               hn_status *ended, hn_diags *diags);
void hn_picture_moment_reset(hn_picture_moment *p);
#endif
