// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_CHILD_H
#define HN_TUI_CHILD_H
// This very program, run beside the workbench for a study: its text arrives as it is written, and
// it can be stopped.

#include "base/strbuf.h"

#include <stdbool.h>
#include <sys/types.h>

typedef struct hn_child {
    pid_t pid; ///< 0: none
    int output;
    int status; ///< how the one before ended: its exit status; -1: by a signal
} hn_child;

/// Starts `holonom` with these arguments (NULL ends them; without the program's name), and tells it
/// that its text has so many columns. false: it could not be started.
bool hn_child_start(hn_child *child, const char *const *arguments, int columns);
/// Adds what has arrived to the text; false when the program has ended (and is forgotten then).
bool hn_child_read(hn_child *child, hn_strbuf *text);
/// Ends it, with what it started.
void hn_child_stop(hn_child *child);
#endif
