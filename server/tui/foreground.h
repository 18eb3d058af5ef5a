// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_FOREGROUND_H
#define HN_TUI_FOREGROUND_H
// The terminal belongs to the job in the foreground: a job in the background waits for it.

#include <stdbool.h>

/// Stops this job, as the system stops one that reads, until the shell has it in the foreground.
/// false: it is in the background and nothing stops it, since no shell would let it go on.
bool hn_foreground_wait(void);
/// Call it once the library of the screen has its own handler of SIGTSTP: from then on that
/// signal, from Ctrl-Z or from another program, waits until the line to the terminal is quiet.
void hn_foreground_watch(void);
/// Returns whether SIGTSTP has come since the last stop.
bool hn_foreground_must_stop(void);
/// Stops this job and leaves the terminal to the shell; returns when it is in the foreground again.
/// A job that is let go on in the background, by the shell or by SIGCONT, stops once more.
void hn_foreground_stop(void);
#endif
