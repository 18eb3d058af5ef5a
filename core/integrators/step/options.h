// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_OPTIONS_H
#define HN_INTEGRATORS_OPTIONS_H
// Options that several integrators share. An integrator's table places them with an enum of its
// own:
//
//     enum { OPT_STEP, OPT_RHO, N_OPTIONS };
//     .n_options = N_OPTIONS,
//     .options = {[OPT_STEP] = HN_OPTION_STEP, [OPT_RHO] = {.key = "rho", ...}}

#include "integrators/step/stepper.h"

/// The step size of integrators with a fixed step.
#define HN_OPTION_STEP \
    { .key = "h", .initial = 1e-3, .min = 1e-12, .max = 100, .unit = "s", .about = "step size" }

#define HN_OPTION_RTOL                                            \
    {                                                             \
        .key = "rtol", .initial = 1e-6, .min = 1e-14, .max = 0.1, \
        .about = "relative error allowed in a step"               \
    }
#define HN_OPTION_ATOL                                                                         \
    {                                                                                          \
        .key = "atol", .max = 1,                                                               \
        .about = "absolute error allowed in a step; 0: rtol, in units of the mechanism where " \
                 "lengths or rates are far from 1 m and 1/s"                                   \
    }
#define HN_OPTION_FIRST_STEP                                          \
    {                                                                 \
        .key = "h0", .max = 100, .unit = "s",                         \
        .about = "first step; 0: chosen from the slopes at the start" \
    }
#define HN_OPTION_LARGEST_STEP \
    { .key = "hmax", .max = 100, .unit = "s", .about = "largest step; 0: no limit" }
/// The option of adaptive integrators that can also run at a fixed step.
#define HN_OPTION_FIXED_STEP \
    { .key = "h", .max = 100, .unit = "s", .about = "fixed step; 0: chosen from rtol and atol" }

/// Places of the options above in the tables of adaptive integrators.
enum {
    HN_ADAPTIVE_RTOL,
    HN_ADAPTIVE_ATOL,
    HN_ADAPTIVE_FIRST_STEP,
    HN_ADAPTIVE_LARGEST_STEP,
    HN_ADAPTIVE_OPTIONS,
    HN_ADAPTIVE_FIXED_STEP = HN_ADAPTIVE_OPTIONS,
    HN_ADAPTIVE_OPTIONS_OR_FIXED
};
#define HN_OPTIONS_ADAPTIVE                                                   \
    [HN_ADAPTIVE_RTOL] = HN_OPTION_RTOL, [HN_ADAPTIVE_ATOL] = HN_OPTION_ATOL, \
    [HN_ADAPTIVE_FIRST_STEP] = HN_OPTION_FIRST_STEP,                          \
    [HN_ADAPTIVE_LARGEST_STEP] = HN_OPTION_LARGEST_STEP
#define HN_OPTIONS_ADAPTIVE_OR_FIXED \
    HN_OPTIONS_ADAPTIVE, [HN_ADAPTIVE_FIXED_STEP] = HN_OPTION_FIXED_STEP

#endif
