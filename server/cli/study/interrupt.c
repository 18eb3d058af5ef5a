// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/interrupt.h"

#include <signal.h>

static volatile sig_atomic_t interrupted;
static struct sigaction before;

static void on_interrupt(int signal) {
    (void)signal;
    interrupted = 1;
}

void hn_interrupt_begin(void) {
    struct sigaction action = {.sa_handler = on_interrupt};
    interrupted = 0;
    sigaction(SIGINT, &action, &before);
}

void hn_interrupt_end(void) {
    sigaction(SIGINT, &before, NULL);
}

int hn_is_interrupted(void *unused) {
    (void)unused;
    return interrupted != 0;
}
