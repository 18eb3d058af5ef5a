// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/foreground.h"

#include <signal.h>
#include <unistd.h>

/// Stops that end in the background: more than anybody who types `bg` again and again, and few
/// enough where the signal stops nothing.
enum { MOST_STOPS = 100 };

/// A terminal that is not the controlling one knows no jobs.
static bool in_background(void) {
    const pid_t front = tcgetpgrp(STDIN_FILENO);
    return front > 0 && front != getpgrp();
}

bool hn_foreground_wait(void) {
    for (int i = 0; i < MOST_STOPS && in_background(); i++) {
        kill(0, SIGTTIN);
    }
    return !in_background();
}
