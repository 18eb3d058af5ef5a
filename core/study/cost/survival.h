// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SURVIVAL_H
#define HN_STUDY_SURVIVAL_H
// Survival of runs through singular configurations, where a loop can fold over into its other
// assembly mode. A run stays with the exact motion, ends early, or leaves the motion with or
// without an incident that says so. Counted over many step sizes this gives "survived n of m".

#include "study/run/walk.h"
#include "study/truth/errors.h"
#include "study/truth/reference.h"

#include <stdbool.h>

/// Outcome of a run compared with the exact motion.
typedef enum hn_survival_end {
    HN_SURVIVAL_SURVIVED, ///< it stayed with the exact motion throughout
    HN_SURVIVAL_OFF,      ///< it left the exact motion, and no loop was seen folded over
    HN_SURVIVAL_STOPPED,  ///< it ended early and said why
    HN_SURVIVAL_TOLD,     ///< it went wrong, and an incident says so
    HN_SURVIVAL_SILENT,   ///< a loop folded over, and nothing was reported
    HN_SURVIVAL_ENDS
} hn_survival_end;
/// Returns the name in tables: "survived", "off", "stopped", "told", "silent".
const char *hn_survival_name(hn_survival_end end);

/// The distance of a sample from the exact motion, and whether a loop has folded over.
typedef struct hn_survival_seen {
    double distance;
    int folded;
} hn_survival_seen;
/// Compares sample k (from 1) with the exact motion.
typedef hn_survival_seen (*hn_survival_look)(void *user, int k, const hn_sample *sample);

typedef struct hn_survival_judge {
    hn_survival_look look;
    void *user;
    double T;      ///< [s]
    int n;         ///< samples, at T (k - before) / n, k = 1..n
    double before; ///< 0: the last sample is at T
    bool at_steps; ///< at the ends of the run's own steps just behind these times
    /// 1: a run that left the motion counts as told where an incident says that it is wrong, folded
    /// or not
    int ask_incidents;
    double limit; ///< of the distance, in its unit
    /// computing time of one run, and `stop`, asked between samples; NULL: none
    const hn_walk_limits *limits;
} hn_survival_judge;

typedef struct hn_survival {
    hn_survival_end end;
    double t;         ///< where it stopped, or was first seen off or folded; T when it survived [s]
    double worst;     ///< largest distance, until it stopped
    char reason[256]; ///< of a run that stopped
} hn_survival;

/// Steps the run, which is at its start, to T. 0: the limits cut it, and nothing is known.
int hn_survival_try(hn_run *run, const hn_survival_judge *judge, hn_survival *out);
/// Step number k of n for a scene with this usual step: evenly from 2.2 to 20 times it, where fixed
/// steps begin to fail.
double hn_survival_step(double usual, int k, int n);

/// A judge for any scene, from its reference solution: the distance is the error of q. Whether a
/// loop has folded over cannot be told from it (a run that is late has its loops the other way
/// round too), so runs that leave the motion are told or off, never silent. `arena` keeps it; free
/// the inside with hn_survival_unjudge(). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
#define HN_SURVIVAL_DISTANCE 1e-2 ///< limit of such a judge
HN_MUST_CHECK hn_status hn_survival_by_reference(const hn_system *sys, const hn_ref *ref,
                                                 hn_arena *arena, hn_survival_judge *out);
void hn_survival_unjudge(hn_survival_judge *judge); ///< NULL `user` is legal
#endif
