// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/interrupt.h"

#include <signal.h>
#include <stdbool.h>

static volatile sig_atomic_t interrupted;
/// Ctrl-C, and what a system sends that wants the program to end.
static const int SIGNALS[] = {SIGINT, SIGTERM};
enum { N_SIGNALS = sizeof SIGNALS / sizeof *SIGNALS };
static struct sigaction before[N_SIGNALS];

static void on_interrupt(int signal) {
    (void)signal;
    interrupted = 1;
}

void hn_interrupt_begin(void) {
    struct sigaction action = {.sa_handler = on_interrupt};
    interrupted = 0;
    for (int i = 0; i < N_SIGNALS; i++) {
        sigaction(SIGNALS[i], &action, &before[i]);
    }
}

void hn_interrupt_end(void) {
    for (int i = 0; i < N_SIGNALS; i++) {
        sigaction(SIGNALS[i], &before[i], NULL);
    }
}

int hn_is_interrupted(void *unused) {
    (void)unused;
    return interrupted != 0;
}
