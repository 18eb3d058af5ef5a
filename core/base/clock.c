// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/clock.h"

#include <time.h>

static double seconds_of(clockid_t clock) {
    struct timespec ts;
    clock_gettime(clock, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

double hn_clock_wall(void) {
    return seconds_of(CLOCK_MONOTONIC);
}

double hn_clock_thread(void) {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double hn_clock_ticks(void) {
#if defined(__x86_64__)
    return (double)__builtin_ia32_rdtsc();
#else
    return 1e9 * hn_clock_wall();
#endif
}
