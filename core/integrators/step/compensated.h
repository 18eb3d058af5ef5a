// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_COMPENSATED_H
#define HN_INTEGRATORS_COMPENSATED_H
// The sum y_new = y + increment over many steps, with what rounding cuts off each time carried into
// the next:
//
//     s = increment + carry,   y_new = y + s,   carry = s - (y_new - y)                       (1)
//
// Plainly summed, n steps lose about sqrt(n) to n times 1e-16 of y; compensated, about 1e-16
// altogether. The carry belongs to the state that the last step left; a state that is mended
// afterwards (projection, a new chart) loses it. Times need none of this: a fixed step's are t0 + n
// h. Source: Kahan 1965; Hairer, Lubich & Wanner 2006, section VIII.5; the difference in (1) is
// exact after Knuth 1969 (two-sum).

#include "base/arena.h"
#include "base/status.h"

typedef struct hn_compensated {
    int on; ///< 0: y + increment as it is
    int n;
    double *kept;  ///< n: carry of the state the next step starts from
    double *trial; ///< n: carry of the step just tried
} hn_compensated;

/// Memory for n entries; returns 0 when the arena has run out. Off until hn_compensated_switch().
HN_MUST_CHECK int hn_compensated_init(hn_compensated *c, int n, hn_arena *arena);
void hn_compensated_switch(hn_compensated *c, int on);
/// Entries first .. first + n - 1: y_new = y + increment; y and y_new from `first` on, increment
/// from its own beginning.
void hn_compensated_add(hn_compensated *c, int first, int n, const double *y,
                        const double *increment, double *y_new);
/// After every accepted step; `changed` 1: the state is not the one the sum left.
void hn_compensated_accepted(hn_compensated *c, int changed);

/// The option "sum" of explicit integrators with a fixed step, and the table it stands in.
#define HN_OPTION_SUM                                                                          \
    {                                                                                          \
        .key = "sum", .max = 1, .choices = hn_compensated_choices, .n_choices = 2,             \
        .about = "plain, or compensated: keeps the rounding errors of millions of small steps" \
    }
enum { HN_FIXED_STEP_H, HN_FIXED_STEP_SUM, HN_FIXED_STEP_OPTIONS };
#define HN_OPTIONS_FIXED_STEP \
    [HN_FIXED_STEP_H] = HN_OPTION_STEP, [HN_FIXED_STEP_SUM] = HN_OPTION_SUM
extern const char *const hn_compensated_choices[2];

#endif
