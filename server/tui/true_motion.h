// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_TRUE_MOTION_H
#define HN_TUI_TRUE_MOTION_H
// The reference motion at the frames of a recording: where the drawn points truly are.

#include "session/references/references.h"

typedef struct hn_true_motion {
    double *points;      ///< owned; 3 n_points a frame, NaN at frames between its samples
    int n_points;        ///< drawn points
    int frames;          ///< that it has
    double own;          ///< its own error [m]
    double digits;       ///< of it that are right [-]
    double energy_scale; ///< scale of its energies [J]
} hn_true_motion;

/// The request of a reference motion.
typedef struct hn_true_motion_request {
    const hn_model *model;
    double frame_dt; ///< [s]
    int last;        ///< frame at the end
    bool compute;    ///< where none is shipped or kept; the computed one is kept
    hn_walk_limits limits;
} hn_true_motion_request;

/// Returns the motion, owned in *out. Fails: HN_ERR_UNSUPPORTED where none is stored and none is to
/// be computed; otherwise as hn_reference_get() and hn_reference_motion_json(), told in diags.
HN_MUST_CHECK hn_status hn_true_motion_get(const hn_true_motion_request *request,
                                           hn_true_motion **out, hn_diags *diags);
void hn_true_motion_free(hn_true_motion *m); ///< NULL is legal
/// Points at a frame (3 n_points); NULL: it has none there.
const double *hn_true_motion_at(const hn_true_motion *m, int frame);
/// Largest distance of a drawn point from where the motion has it [m], at least the motion's own
/// error; NaN where it has no points at this frame.
double hn_true_motion_error(const hn_true_motion *m, const double *points, int frame);
#endif
