// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_LOOKOUT_H
#define HN_DYNAMICS_LOOKOUT_H
// Looks ahead of a motion for singular configurations: a pilot run (pilot.h) goes a given time
// ahead of the present state and probes sigma_min at its steps, and inside those whose ends do not
// rule a zero out. sigma_min falls towards a zero and rises from it like a straight line.
//
// A pilot run that has found nothing is kept. The next look goes on from its end, if the motion has
// since followed it; otherwise, and before anything is announced, one starts at the present state.

#include "base/arena.h"
#include "dynamics/analyse/pilot.h"
#include "dynamics/compile/system.h"

typedef struct hn_lookout hn_lookout;

/// The aim of a pilot run: sigma_min below `reached`. `probe` returns sigma_min at a configuration
/// (nq).
typedef struct hn_lookout_aim {
    double (*probe)(void *user, double t, const double *q);
    void *user;
    double reached;
} hn_lookout_aim;

/// Memory from `arena`. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_lookout_create(const hn_system *sys, hn_arena *arena, hn_lookout **out);
void hn_lookout_free(hn_lookout *l); ///< NULL is legal
/// Forgets the last pilot run.
void hn_lookout_reset(hn_lookout *l);

/// Seconds from the state q (nq), v (nv) at time t until a pilot run reaches what `aim` describes
/// within `horizon` [s], confirmed by a second run with finer steps; HUGE_VAL: it does not.
/// `sigma_now` is sigma_min here; *lowest gets it there. Allocates nothing.
double hn_lookout_search(hn_lookout *l, double t, const double *q, const double *v, double horizon,
                         double sigma_now, const hn_lookout_aim *aim, double *lowest);

/// The pilot, for other questions: a search starts it anew.
hn_pilot *hn_lookout_pilot(hn_lookout *l);
#endif
