// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_DRAG_H
#define HN_DYNAMICS_DRAG_H
// A closed mechanism, dragged: the pose with closed loops at which one point, or one coordinate, is
// nearest to a target, reached from a given pose without leaving the constraints.
//
//     minimise 1/2 |p(q) - target|^2   subject to phi(q, t) = 0                                (1)
//
// Each step solves the damped Gauss-Newton equations of (1) on the constraints,
//
//     (A'A + mu D) d = A'(target - p) + J' lambda,   J d + phi = 0,   A = dp/dq                (2)
//
// moves by d, and closes the loops again by projection. A step that comes no nearer, or that the
// projection carries off to another branch, is tried again with more damping.
// Source: Nocedal & Wright 2006, sections 10.3 and 18.1.

#include "dynamics/compile/system.h"

typedef struct hn_drag_goal {
    int point;      ///< index of a world point; -1: a coordinate is dragged
    int coordinate; ///< user coordinate (0..n_user-1), where point is -1
    int n;          ///< how many numbers of `target` count: 3, 2 (x and y), of a coordinate 1
    double target[3];
} hn_drag_goal;

typedef enum hn_drag_end {
    HN_DRAG_REACHED, ///< the target is met to rounding
    HN_DRAG_NEAREST, ///< no closed pose around here is nearer
    HN_DRAG_TIME,    ///< the computing time was over on the way
    HN_DRAG_STUCK    ///< no step closes its loops any more
} hn_drag_end;

typedef struct hn_drag_info {
    hn_drag_end end;
    double distance_before, distance; ///< to the target [m, or the unit of the coordinate]
    double gap;                       ///< ||phi|| at the end [row units]
    int steps;
} hn_drag_info;

/// Moves q (system coordinates, nearly closed at time t) towards the goal. `seconds` of computing
/// are allowed, the making of evaluators left out. q is always a closed pose afterwards, the
/// nearest so far. Fails, with q untouched: HN_ERR_NO_CONVERGENCE and HN_ERR_DIVERGED (the loops
/// cannot be closed near the pose given), HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_drag(const hn_system *sys, double t, const hn_drag_goal *goal,
                                double seconds, double *q, hn_drag_info *info);

#endif
