// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SINGULARITY_MONITOR_H
#define HN_DYNAMICS_SINGULARITY_MONITOR_H
// The singularity monitor: how far a motion is from a configuration where closure rows depend on
// each other, when it will be there, and what kind of configuration that is.
//
//     sigma = singular values of R J D,   D = diag(M)^-1/2                                     (1)
//     R = one over the largest length that each row of J D has had
//
// A row that vanishes makes sigma_min small, and so do two rows that become parallel. The ratio
// sigma_min / sigma_max has no unit. sigma_min comes from inverse iteration with the sparse factor
// of [D^-2 J'; J 0], started from the last answer: a check costs as much as J and the factor have
// entries. If the factor has lost a pivot, a dense rank-revealing QR answers.
//
// Prediction. When sigma_min falls and is below 97 % of its largest value so far, a pilot run
// (pilot.h) goes ahead by half a turn of the fastest coordinate; a configuration is announced only
// if that run reaches it.
// Extrapolation would warn falsely: sigma_min of a crank-rocker falls almost linearly to 0.27 and
// then rises again.
//
// A motion along a closed curve of configurations needs no pilot run once it has been all the way
// round (round_trip.h).
//
// Branches. With w' J = 0 the velocities v that J allows must also obey w' gamma(q, v) = 0, a
// quadratic form. With two degrees of freedom at the configuration, two real roots: two branches
// cross; none: the mechanism is locked; a double root: a cusp.
// Source: Gosselin & Angeles 1990; Golub & Van Loan 2013, section 8.2.

#include "base/arena.h"
#include "dynamics/analyse/pilot.h"
#include "dynamics/compile/system.h"

#include <math.h>

typedef enum hn_branches {
    HN_BRANCHES_UNKNOWN, ///< more than one row is lost, or time enters the rows
    HN_BRANCHES_CROSS,
    HN_BRANCHES_NONE,
    HN_BRANCHES_CUSP
} hn_branches;

typedef struct hn_singularity_info {
    /// of the rows that count (those that do not always depend on others) [-]
    double sigma_min, sigma_max;
    double ratio; ///< sigma_min / sigma_max; 1 without rows
    /// rows lost beyond those that were dependent at the first check; 0 unless ratio < 1e-8
    int lost;
    /// seconds until a singular configuration that the pilot run has just reached, else HUGE_VAL;
    /// said once for each
    double ahead;
    double lowest;    ///< sigma_min there, where `ahead` is finite
    double predicted; ///< time of the last one that was announced, -HUGE_VAL: none so far
} hn_singularity_info;

/// The description of a configuration where rows nearly depend on each other.
typedef struct hn_singularity_pose {
    int mobility_before, mobility; ///< degrees of freedom off the pose, and at it
    hn_branches branches;
    int n_rows, rows[4]; ///< rows with the largest part in what is lost, largest first
    double parts[4];     ///< and their parts, of 1
} hn_singularity_pose;

typedef struct hn_singularity hn_singularity;
/// Memory from `arena`. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_singularity_create(const hn_system *sys, hn_arena *arena,
                                              hn_singularity **out);
void hn_singularity_free(hn_singularity *r); ///< NULL is legal
/// Forgets all checks.
void hn_singularity_reset(hn_singularity *r);
/// Checks a state; times should rise. Allocates nothing.
void hn_singularity_check(hn_singularity *r, double t, const double *q, const double *v,
                          hn_singularity_info *info);
/// Finds the singular values at a pose: sigma_min, the largest sigma_max so far with this one
/// included, and their ratio. The record of the checks stays as it is. Returns false, and leaves
/// `info` alone, before the first check, and where a check costs so much that not every state gets
/// one. Allocates nothing.
bool hn_singularity_probe_both(hn_singularity *r, double t, const double *q,
                               hn_singularity_info *info);
/// sigma_min alone; HUGE_VAL where there is none.
static inline double hn_singularity_probe(hn_singularity *r, double t, const double *q) {
    hn_singularity_info info = {0};
    return hn_singularity_probe_both(r, t, q, &info) ? info.sigma_min : HUGE_VAL;
}
/// Returns whether some of the rows that are dependent at this pose become independent after a
/// small displacement along velocities that J allows. Dense, for poses that are reported; after
/// the first check. Allocates nothing.
bool hn_singularity_is_local(hn_singularity *r, double t, const double *q);
/// D of the last check (nv): velocities divided by it compare [1 / sqrt(kg) or 1 / (m sqrt(kg))].
const double *hn_singularity_scale(const hn_singularity *r);
/// The pilot run that the monitor uses during its checks; free for others between them.
hn_pilot *hn_singularity_pilot(hn_singularity *r);
/// Describes the pose of the last check or probe, from all singular values (dense: for poses that
/// are reported); `sigma_min` is the value that it returned.
void hn_singularity_pose_at(hn_singularity *r, double t, const double *q, double sigma_min,
                            hn_singularity_pose *pose);

#endif
