// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_POSE_SOLVER_H
#define HN_GRADE_POSE_SOLVER_H
// Closed poses of a mechanism near a given one, and the direction in which it can move there.
//
// Newton's method with least-norm corrections,
//
//     J_f d = -phi,   |d / reach| least,                                                     (1)
//
// where J_f has the columns of the coordinates that may move, in the scene's own coordinates, and
// `reach` is 1 rad or the characteristic length. A correction is cut to half a radian, and halved
// until |phi| falls. Source: Wehage & Haug 1982.

#include "session/model/model.h"

#include <stdbool.h>

typedef struct hn_pose_solver hn_pose_solver;

/// Starts at the assembled start of the model, which must outlive the solver.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_pose_solver_create(const hn_model *model, hn_pose_solver **out);
void hn_pose_solver_free(hn_pose_solver *s);       ///< NULL is legal
int hn_pose_solver_count(const hn_pose_solver *s); ///< coordinates, n
/// The pose in the scene's coordinates (n), borrowed; and the drawn points (3 each), [m].
const double *hn_pose_solver_coordinates(const hn_pose_solver *s);
const double *hn_pose_solver_points(const hn_pose_solver *s);
/// Largest |phi| of the pose, in units of the rows (lengths by the characteristic length).
double hn_pose_solver_gap(const hn_pose_solver *s);
/// Length of phi, in metres or radians as its rows are: the gap that pictures and runs show.
double hn_pose_solver_open(const hn_pose_solver *s);
/// 1 rad, or the characteristic length [m], of a coordinate.
double hn_pose_solver_reach(const hn_pose_solver *s, int coordinate);
/// Places the mechanism as it is told, loops open or not.
void hn_pose_solver_place(hn_pose_solver *s, const double *coordinates);
/// Closes the loops; `held` (n; NULL: none) are the coordinates that keep their values. The pose is
/// the nearest one found when it fails: HN_ERR_UNREACHABLE.
HN_MUST_CHECK hn_status hn_pose_solver_close(hn_pose_solver *s, const bool *held);
/// The direction in which a closed mechanism with one degree of freedom can move: user rates (n) of
/// length 1, each divided by its reach. Returns the degrees of freedom; `direction` is set where
/// they are 1.
int hn_pose_solver_direction(hn_pose_solver *s, double *direction);
/// Returns whether every loop has the same assembly mode in two poses (n coordinates each); true
/// where the modes of a loop are not told apart, or memory is out.
bool hn_pose_solver_same_modes(const hn_pose_solver *s, const double *one, const double *other);
#endif
