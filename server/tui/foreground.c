// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/foreground.h"

#include <signal.h>
#include <unistd.h>

/// Stops that end in the background: more than anybody who types `bg` again and again, and few
/// enough where the signal stops nothing.
enum { MOST_STOPS = 100 };

static volatile sig_atomic_t must_stop;
static struct sigaction of_screen; ///< what the library of the screen does at SIGTSTP

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

static void want_stop(int number) {
    (void)number;
    must_stop = 1;
}

void hn_foreground_watch(void) {
    const struct sigaction ours = {.sa_handler = want_stop};
    const bool known = sigaction(SIGTSTP, NULL, &of_screen) == 0;
    if (known && of_screen.sa_handler != SIG_IGN && of_screen.sa_handler != want_stop) {
        sigaction(SIGTSTP, &ours, NULL);
    }
}

bool hn_foreground_must_stop(void) {
    return must_stop;
}

void hn_foreground_stop(void) {
    struct sigaction ours;
    must_stop = 0;
    sigaction(SIGTSTP, &of_screen, &ours);

    // a job that goes on in the background stops when it sets the terminal's modes
    signal(SIGTTOU, SIG_DFL);
    kill(0, SIGTSTP);
    signal(SIGTTOU, SIG_IGN);
    sigaction(SIGTSTP, &ours, NULL);
}
