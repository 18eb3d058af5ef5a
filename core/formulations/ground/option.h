// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_OPTION_H
#define HN_FORMULATIONS_OPTION_H
// One option of a formulation or an integrator, as in "alpha=20". (A scene has parameters, a method
// has options.)

#include "base/diag.h"
#include "base/status.h"

#include <stdbool.h>

enum { HN_MAX_OPTIONS = 9 };

typedef struct hn_option {
    const char *key;
    double initial, min, max;   ///< NaN initial: required
    const char *unit, *about;   ///< unit NULL: none
    const char *const *choices; ///< named values (0, 1, ...) or NULL; spelled by name
    int n_choices;
    bool warn_below_zero; ///< allowed, with a warning ("pushes the loop apart")
} hn_option;

/// Checks one value against its option: HN_OK, or HN_ERR_INPUT with the reason in diag (no column).
HN_MUST_CHECK hn_status hn_option_check(const hn_option *option, double value, hn_diag *diag);
/// Reads and checks one value ("0.02", "0,02", "20 ms", "auto"). Fails as hn_option_check().
HN_MUST_CHECK hn_status hn_option_parse(const hn_option *option, const char *text, double *value,
                                        hn_diag *diag);

#endif
