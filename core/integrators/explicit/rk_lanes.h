// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_RK_LANES_H
#define HN_INTEGRATORS_RK_LANES_H
// Explicit Runge-Kutta steps of y = (q, v), q' = v, v' = a(t, q, v), for HN_LANES states at once,
// each with a time and a step of its own. Every operation is that of explicit_rk.c, in its order,
// so that a lane has the bits of a single step.

#include "dynamics/evaluate/accel_lanes.h"
#include "integrators/explicit/tableau.h"

typedef struct hn_rk_lanes {
    const hn_tableau *tab;
    hn_accel_lanes accel; ///< alpha and beta of each lane are set there
    int n;                ///< entries of y: 2 nv
    double *y;            ///< n blocks of HN_LANES: the states to step from
    double *y_new;        ///< the same, where they got to
    double *h;            ///< HN_LANES [s]
    double *t;            ///< HN_LANES [s], times of y
    double *k;            ///< stages x n blocks: slopes
    double *increment;    ///< n blocks
} hn_rk_lanes;

/// Memory for steps with the accelerations of `accel`, which must outlive it; all entries are 0.
/// The tableau has no stage that the next step uses again. Fails: HN_ERR_MEMORY; HN_ERR_UNSUPPORTED
/// where the solver has no tape or positions are not integrals of the speeds (quaternions).
HN_MUST_CHECK hn_status hn_rk_lanes_create(const hn_tableau *tab, const hn_accel *accel,
                                           hn_lanes_set set, hn_arena *arena, hn_rk_lanes *out);
void hn_rk_lanes_free(hn_rk_lanes *rk); ///< what is not from the arena
/// Steps all lanes from (t, y) to y_new. Returns those whose slopes were all sure and whose new
/// state is below `bound` in every entry; of the others y_new means nothing. Allocates nothing.
hn_lane_bits hn_rk_lanes_step(hn_rk_lanes *rk, double bound);
/// The new states become the present ones.
void hn_rk_lanes_accept(hn_rk_lanes *rk);
#endif
