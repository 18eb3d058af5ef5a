// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_PULL_H
#define HN_DYNAMICS_PULL_H
// Pulls: a hand holds one point of the mechanism by a spring with a damper, and moves its other end
// while the mechanism runs. A scene that was given a load for the point (hn_scene_add_pull) has
// five inputs for it in every tape: stiffness, damping and the place of the hand. The log says
// which values they have at which time.
//
// The hand is at rest between two entries of the log. The time of an entry is a corner of a load
// (system.h), at which integrators start anew.

#include "base/status.h"

#include <stdbool.h>

enum { HN_PULL_INPUTS = 5, HN_PULL_MOST_ENTRIES = 20000 };

/// A hold on a point from some time on: force = stiffness (to - place) - damping (velocity).
typedef struct hn_pull {
    int point;                 ///< of the drawing
    double to[3];              ///< place of the hand, world [m]
    double stiffness, damping; ///< [N/m], [N s/m]; both 0: the hand lets go
} hn_pull;

typedef struct hn_pull_log hn_pull_log;

/// Makes an empty log for the given points. Returns NULL when memory is out.
hn_pull_log *hn_pull_log_create(const int *points, int n_points);
void hn_pull_log_free(hn_pull_log *log); ///< NULL is legal
/// Returns the place of the point among the points of the log; -1: it has none.
int hn_pull_log_find(const hn_pull_log *log, int point);
/// Adds what holds from the time t on [s]. A time before that of the last entry counts as the
/// latter. Every other point is let go. Fails: HN_ERR_INPUT (no point of the log), HN_ERR_LIMIT,
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_pull_log_add(hn_pull_log *log, double t, const hn_pull *pull);
void hn_pull_log_clear(hn_pull_log *log); ///< removes all entries, and the stop
/// Adds a corner ahead of all entries at t, or none with HUGE_VAL: steps end there, so that the
/// next entry is felt soon.
void hn_pull_log_set_stop(hn_pull_log *log, double t);
/// The first corner after t [s]; HUGE_VAL: none.
double hn_pull_log_next_corner(const hn_pull_log *log, double t);
/// Returns the entry that holds at t; NULL where nothing is held.
const hn_pull *hn_pull_log_at(const hn_pull_log *log, double t);
/// Writes HN_PULL_INPUTS values for every point of the log as they are at t: stiffness, damping,
/// and the place of the hand; zeros for a point that is not held.
void hn_pull_log_put(const hn_pull_log *log, double t, double *inputs);

#endif
