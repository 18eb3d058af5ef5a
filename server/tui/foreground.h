// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_FOREGROUND_H
#define HN_TUI_FOREGROUND_H
// The terminal belongs to the job in the foreground: a job in the background waits for it.

#include <stdbool.h>

/// Stops this job, as the system stops one that reads, until the shell has it in the foreground.
/// false: it is in the background and nothing stops it, since no shell would let it go on.
bool hn_foreground_wait(void);
#endif
