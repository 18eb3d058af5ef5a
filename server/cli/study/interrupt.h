// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_INTERRUPT_H
#define HN_CLI_INTERRUPT_H
// Ctrl-C, or SIGTERM, asks a long job to stop instead of ending the program: it says what it kept.

#include "base/status.h"

#include <stdbool.h>

/// Between the two calls the signals are taken; before and after they end the program.
void hn_interrupt_begin(void);
void hn_interrupt_end(void);
int hn_is_interrupted(void *unused); ///< 1 once asked: the `stop` of a job
#endif
