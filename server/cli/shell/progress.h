// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_PROGRESS_H
#define HN_CLI_PROGRESS_H
// The progress line of long computations.

#include "base/status.h"

/// A line on standard error for what takes longer than a second, only if that is a terminal. Zeroed
/// to begin with.
typedef struct hn_progress {
    double started, last;
    double begun,
        /// when the share began to rise, and from where: work taken up from before took no time now
        first;
    int shown;
} hn_progress;
void hn_progress_tell(hn_progress *p, const char *what, double share);
void hn_progress_end(hn_progress *p);
#endif
