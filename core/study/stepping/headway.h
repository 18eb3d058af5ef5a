// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_HEADWAY_H
#define HN_STUDY_HEADWAY_H
// Progress of a run: refuses more fixed steps than are allowed before the first one, and sees steps
// that collapse, so that no run spends minutes without advancing.

#include "base/status.h"

struct hn_stepping;

/// A pace that needs more steps than this to the time asked for is reported.
#define HN_HEADWAY_MANY 2e6

/// The pace of the last window of trial steps.
typedef struct hn_headway {
    double t;                     ///< start of the present window
    long long attempts, rejected; ///< trial steps until then, and those of them that were rejected
    double needed;                ///< steps to the time asked for at the pace of the last window
    double advance;               ///< that the last window made [s]
    long long tried, refused;     ///< trial steps and rejections in the last window
    int slow;                     ///< consecutive windows at whose pace the step limit is too small
} hn_headway;

/// Checks that the fixed steps to t_end are within the step limit.
/// Fails: HN_ERR_STOPPED with the number in the reason of `s`.
HN_MUST_CHECK hn_status hn_headway_check_steps(struct hn_stepping *s, double t_end);
/// Called after each accepted step: measures the pace.
/// Fails: HN_ERR_STEP_UNDERFLOW with the cause in the reason of `s` where the steps stay collapsed.
HN_MUST_CHECK hn_status hn_headway_step(struct hn_stepping *s);
/// The reason why steps are short: what stopped the last trial, or the error estimate.
void hn_headway_describe(const struct hn_stepping *s, char *out, size_t size);

#endif
