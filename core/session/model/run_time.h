// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_RUN_TIME_H
#define HN_SESSION_RUN_TIME_H
// The bound of times that may be asked for, the same for runs, comparisons, pictures and studies.

#include "base/diag.h"

#include <stdbool.h>

#define HN_RUN_TIME_MAX 1e6 ///< [s]

/// Checks a time [s]: at most HN_RUN_TIME_MAX, and above 0, or from 0 on where `zero` is allowed.
/// Reports "the NAME is ..." at `pointer`. Fails: HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_run_time_check(double time, bool zero, const char *name,
                                          const char *pointer, hn_diags *diags);

#endif
