// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_PILOT_H
#define HN_DYNAMICS_PILOT_H
// A pilot run: a copy of the motion, run a little ahead of it from the present state.
//
// It integrates the accelerations by RK4 with steps of a few degrees. Over the half turn
// that it runs, its loops stay closed far better than the questions need that are asked of it.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_pilot hn_pilot;

/// Memory from `arena`, the tape owned by the pilot. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_pilot_create(const hn_system *sys, hn_arena *arena, hn_pilot **out);
void hn_pilot_free(hn_pilot *p); ///< NULL is legal

/// The time in which the fastest coordinate turns by half a turn, or moves as far against
/// the characteristic length, at velocities v (nv) [s]; HUGE_VAL at rest.
double hn_pilot_half_turn(const hn_pilot *p, const double *v);

/// Starts at the state q (nq), v (nv) at time t.
void hn_pilot_start(hn_pilot *p, double t, const double *q, const double *v);
/// One step of h [s]. Allocates nothing. Fails as hn_accel_eval() does; the state is then
/// unchanged.
HN_MUST_CHECK hn_status hn_pilot_step(hn_pilot *p, double h);
double hn_pilot_time(const hn_pilot *p);
const double *hn_pilot_q(const hn_pilot *p); ///< nq, of the present state
const double *hn_pilot_v(const hn_pilot *p); ///< nv
/// Writes q (nq) at a share 0 .. 1 of the last step, by cubic Hermite interpolation.
void hn_pilot_inside(hn_pilot *p, double share, double *q);

#endif
