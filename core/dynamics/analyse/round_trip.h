// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ROUND_TRIP_H
#define HN_DYNAMICS_ROUND_TRIP_H
// Detects a motion that repeats its closed curve of configurations. A mechanism with one degree of
// freedom that no time moves runs along one curve of configurations. Once a joint has made a full
// turn and all coordinates have their first values again, angles up to full turns, the mechanism
// has passed the whole curve, whatever the loads do: no new configuration lies ahead, and no pilot
// run is needed (lookout.h).
//
// A mechanism that swings to and fro is no such case: with more energy it swings further.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_round_trip hn_round_trip;

/// Memory from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_round_trip_create(const hn_system *sys, hn_arena *arena,
                                             hn_round_trip **out);
/// Forgets the way so far.
void hn_round_trip_reset(hn_round_trip *r);

/// Takes the next state on the way, q and v (nv each) at time t, where sigma_min is `sigma`.
/// Returns the configuration (nq, borrowed) where the way has just closed, *start being sigma_min
/// as it was there at the beginning; else NULL. Each further turn is compared in the same way; one
/// that leaves the curve makes the way begin anew. Allocates nothing.
const double *hn_round_trip_look(hn_round_trip *r, double t, const double *q, const double *v,
                                 double sigma, double *start);
/// Forgets that the way has closed: what was found there is another pose.
void hn_round_trip_reject(hn_round_trip *r);
/// The lowest sigma_min along the whole closed way; 0 while it is not known to be closed.
double hn_round_trip_lowest(const hn_round_trip *r);

#endif
