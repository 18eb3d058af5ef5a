// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SURVIVAL_H
#define HN_STUDY_SURVIVAL_H
// What becomes of a run that has to come through poses where the loops lose rank and could fold
// over: it stays with the exact motion, or it does not, and then says so, or not. Counted over many
// steps this is "survived n of m", which no single run shows.

#include "study/truth/errors.h"
#include "study/truth/reference.h"
#include "study/run/walk.h"

#include <stdbool.h>

#define HN_SURVIVAL_LIST(X)                                                                  \
    X(HN_SURVIVAL_SURVIVED, "survived", "stayed with the exact motion throughout")           \
    X(HN_SURVIVAL_OFF, "off", "left the exact motion, no loop seen folded over: inaccurate") \
    X(HN_SURVIVAL_STOPPED, "stopped", "ended early and said why")                            \
    X(HN_SURVIVAL_TOLD, "told", "went wrong, and an incident says so")                       \
    X(HN_SURVIVAL_SILENT, "silent", "a loop folded over, and nothing was reported")
typedef enum hn_survival_end {
#define HN_SURVIVAL_ENUM(code, name, about) code,
    HN_SURVIVAL_LIST(HN_SURVIVAL_ENUM)
#undef HN_SURVIVAL_ENUM
        HN_SURVIVAL_ENDS
} hn_survival_end;
/// Columns 2 and 3 of HN_SURVIVAL_LIST.
const char *hn_survival_name(hn_survival_end end);
const char *hn_survival_about(hn_survival_end end);

/// How far a sample is from the exact motion, and whether a loop has folded over. `k` counts the
/// looks from 1.
typedef struct hn_survival_seen {
    double distance;
    int folded;
} hn_survival_seen;
typedef hn_survival_seen (*hn_survival_look)(void *user, int k, const hn_sample *sample);

typedef struct hn_survival_judge {
    hn_survival_look look;
    void *user;
    double T;      ///< [s]
    int n;         ///< looks, at T (k - before) / n, k = 1..n
    double before; ///< 0: the last look is at T
    bool at_steps; ///< at the run's own times just behind these
    /// 1: a run that left the motion counts as told where an incident says that it is wrong, folded
    /// or not
    int ask_incidents;
    double limit; ///< of the distance, in its unit
    /// computing time of one run, and `stop`, asked between looks; NULL: none
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
