// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_PULL_FORCE_H
#define HN_DYNAMICS_PULL_FORCE_H
// The force of the hand that pulls (dynamics/compile/pull.h) on a state.

#include "base/arena.h"
#include "dynamics/compile/system.h"

typedef struct hn_pull_force hn_pull_force;

/// For a system with pulls. Memory from `arena`, the tape owned by it. It adds nodes to the graph,
/// see system.h. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_pull_force_create(const hn_system *sys, hn_arena *arena,
                                             hn_pull_force **out);
void hn_pull_force_free(hn_pull_force *p); ///< NULL is legal
/// Writes the force at time t on the state q, v of user coordinates, in world axes [N]; zeros where
/// nothing is held. Allocates nothing.
void hn_pull_force_run(hn_pull_force *p, double t, const double *user_q, const double *user_v,
                       double force[3]);

#endif
