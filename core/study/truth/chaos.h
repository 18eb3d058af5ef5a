// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CHAOS_H
#define HN_STUDY_CHAOS_H
// Measures how fast neighbouring motions of a mechanism part. If they part exponentially, no
// method can follow the motion for long, and errors after a horizon say nothing about methods.
//
// Two motions, d0 apart, are followed for a window; the twin is then brought back to d0 from the
// other along the line between them, and so on. With d_k the distance at the end of window k,
//
//     lambda = 1 / T  sum ln(d_k / d0)                                                          (1)
//
// Regular motions part like t: between T / 2 and T by a factor 2, however large T is. Chaotic ones
// part by exp(lambda T / 2). The estimate is that of the second half, when the twin has turned into
// the fastest direction.
// Source: Benettin, Galgani and Strelcyn 1976; Hairer, Lubich and Wanner 2006, section I.1, for
// what that means for errors.

#include "study/run/walk.h"

#include <stdbool.h>

typedef struct hn_chaos {
    int possible;                ///< 0: cannot be chaotic, `why` says so, and nothing was computed
    bool chaotic;                ///< the second half parts by more than HN_CHAOS_PARTING
    double exponent;             ///< lambda of the second half [1/s]; 0 when not possible
    double growth, growth_first; ///< ln of the growth in the second and in the first half
    double T, window;            ///< [s]
    int windows;
    char why[200]; ///< one clause for people, with the numbers
} hn_chaos;

#define HN_CHAOS_PARTING 2.0 ///< in ln, over half the time: 7.4; regular motions give ln 2

/// From the assembled state (q, v), system coordinates, to T. Fails: HN_ERR_INPUT (T),
/// HN_ERR_STOPPED (stopped), HN_ERR_NO_CONVERGENCE (a motion did not come to T: told in diag),
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_chaos_estimate(const hn_system *sys, const double *q, const double *v,
                                          double T, const hn_walk_limits *limits, hn_chaos *out,
                                          hn_diag *diag);
/// The time at which a difference of `small` has grown to `large` [s]; HUGE_VAL when not chaotic.
double hn_chaos_horizon(const hn_chaos *chaos, double small, double large);
#endif
