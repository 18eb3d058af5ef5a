// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_PROCESSORS_H
#define HN_BASE_PROCESSORS_H
// Counts the processors that this process may use.

/// Processors that the process may use (its affinity, where the system tells it), at least 1.
int hn_processors(void);
#endif
