// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/step_clock.h"

#include "base/clock.h"

#include <math.h>

enum { BLOCK = 64 };
// A longer time between two intervals is the caller's: it may have slept.
static const double LONG_BREAK = 1e-4; // [s]

/// The median of some pairs of readings with nothing between.
static double calc_grain(void) {
    enum { PAIRS = 15 };
    double cost[PAIRS];
    for (int i = 0; i < PAIRS; i++) {
        const double mark = hn_clock_wall();
        const double d = hn_clock_wall() - mark;
        int k = i;
        for (; k > 0 && cost[k - 1] > d; k--) {
            cost[k] = cost[k - 1];
        }
        cost[k] = d;
    }
    return cost[PAIRS / 2];
}

void hn_step_clock_create(hn_step_clock *c) {
    *c = (hn_step_clock){.grain = calc_grain()};
}

void hn_step_clock_clear(hn_step_clock *c) {
    *c = (hn_step_clock){.grain = c->grain};
}

/// CPU time of the intervals of the present block. Undisturbed it is their wall time. A thread that
/// had to wait for a processor has used less: then the steps get their share of the block.
static double calc_block(const hn_step_clock *c) {
    const double wall = c->own + c->between;
    if (c->n == 0 || !(wall > 0)) {
        return 0;
    }
    const double cpu = hn_clock_thread() - c->cpu_mark;
    return fmin(c->own, cpu * c->own / wall);
}

void hn_step_clock_start(hn_step_clock *c) {
    if (c->n == 0) {
        c->cpu_mark = hn_clock_thread();
        c->own = c->between = 0;
        c->started = hn_clock_wall();
        return;
    }
    c->started = hn_clock_wall();
    const double between = c->started - c->stopped;
    c->between += between < LONG_BREAK ? between : 0;
}

void hn_step_clock_stop(hn_step_clock *c) {
    c->stopped = hn_clock_wall();
    c->own += fmax(0, c->stopped - c->started - c->grain);
    if (++c->n == BLOCK) {
        c->seconds += calc_block(c);
        c->n = 0;
    }
}

double hn_step_clock_read(const hn_step_clock *c) {
    return c->seconds + calc_block(c);
}
