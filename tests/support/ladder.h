// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_LADDER_H
#define HN_SUPPORT_LADDER_H
// The ladder of N four-bars and its exact motion, for tests of what methods make of its flat poses.
// Twice a turn all bars lie on one line and every loop could fold over; the exact motion goes
// straight through.

#include "study/cost/survival.h"
#include "support/model.h"

enum { HN_LADDER_GRID = 10000 };

/// All verticals turn alike: ((N+1)/3 + N) b'' = g ((N+1)/2 + N) sin b, b clockwise from the
/// upright, b = 0 and b' = 1 at the start.
typedef struct hn_ladder_motion {
    int n_loops;
    double duration; ///< [s]
    double b[HN_LADDER_GRID + 1], rate[HN_LADDER_GRID + 1];
} hn_ladder_motion;

void hn_ladder_motion_fill(hn_ladder_motion *motion, int n_loops, double duration);
/// b at 0 <= t <= duration [rad].
double hn_ladder_motion_angle(const hn_ladder_motion *motion, double t);

/// Returns what became of one run: survived is within 1e-2 m of the exact motion throughout, off is
/// not as near but with parallel verticals. Runs `method` ("projection@rk4:h=0.01") over the whole
/// motion. *worst (may be NULL): the largest distance of a tip from its exact place at a hundred
/// times and more [m], until the run stopped.
hn_survival_end hn_ladder_run(const hn_model *m, const hn_ladder_motion *motion, const char *method,
                              double *worst);
/// Whether `method` costs the same operations for each loop over `time` [s] with 10 loops and with
/// 200, within a factor 1.5; stops the test where it does not, where a step fell back to the dense
/// solver, or where there were not `evals` right-hand sides (0: any number).
void hn_ladder_check_cost(const char *method, double time, long long evals);
/// The k-th of n steps from 0.0022 s to 0.02 s.
double hn_ladder_step(int k, int n);

#endif
