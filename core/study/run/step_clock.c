// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/step_clock.h"

#include "base/clock.h"

#include <math.h>

enum { BLOCK = 64, SPARSE = 7 }; // intervals read in a block; a prime keeps no step with anything
// Time of a pair of readings: where intervals are shorter on average, the pairs would be 2 % of
// them.
static const double SHORT = 50;
// A longer time between two intervals is the caller's: it may have slept.
static const double LONG_BREAK = 1e-4; // [s]

/// Finds the median of some pairs of readings with nothing between, and the ticks of a long break.
static void calibrate(hn_step_clock *c) {
    enum { PAIRS = 15 };
    double cost[PAIRS];
    const double wall = hn_clock_wall(), first = hn_clock_ticks();
    for (int i = 0; i < PAIRS; i++) {
        const double mark = hn_clock_ticks();
        const double d = hn_clock_ticks() - mark;
        int k = i;
        for (; k > 0 && cost[k - 1] > d; k--) {
            cost[k] = cost[k - 1];
        }
        cost[k] = d;
    }

    // a microsecond or less is long enough to know the counter's pace to a few per cent
    double passed = hn_clock_wall() - wall;
    while (!(passed > 0)) {
        passed = hn_clock_wall() - wall;
    }
    c->grain = cost[PAIRS / 2];
    c->pause = LONG_BREAK * (hn_clock_ticks() - first) / passed;
}

void hn_step_clock_create(hn_step_clock *c) {
    *c = (hn_step_clock){0};
    calibrate(c);
}

void hn_step_clock_clear(hn_step_clock *c) {
    *c = (hn_step_clock){.grain = c->grain, .pause = c->pause};
}

/// Ticks of all intervals of the present block, those that were not read included.
static double own_ticks(const hn_step_clock *c) {
    return c->n_read > 0 ? c->own * c->n / c->n_read : 0;
}

/// CPU time of the present block until now, or until the end of its last interval.
static double used_cpu(const hn_step_clock *c) {
    return (c->cpu_stopped > 0 ? c->cpu_stopped : hn_clock_thread()) - c->cpu_mark;
}

/// CPU time of the intervals of the present block. Undisturbed it is their wall time. A thread that
/// had to wait for a processor has used less: then the steps get their share of the block.
static double calc_block(const hn_step_clock *c) {
    const double all = c->own + c->between, passed = hn_clock_ticks() - c->mark;
    if (c->n == 0 || !(all > 0) || !(passed > 0)) {
        return 0;
    }
    const double cpu = used_cpu(c), tick = (hn_clock_wall() - c->wall_mark) / passed;
    return fmin(own_ticks(c) * tick, cpu * c->own / all);
}

/// Opens a block. The last one says how long an interval is; before there is one all are read.
static void open_block(hn_step_clock *c) {
    const bool is_short = c->n_read == BLOCK && c->own < SHORT * c->grain * c->n_read;
    c->every = is_short ? SPARSE : 1;
    c->until = c->n_read = 0;
    c->cpu_mark = hn_clock_thread();
    c->wall_mark = hn_clock_wall();
    c->own = c->between = c->cpu_stopped = 0;
    c->mark = c->stopped = hn_clock_ticks();
}

void hn_step_clock_start(hn_step_clock *c) {
    const bool read_last = c->n > 0 && c->reading;
    if (c->n == 0) {
        open_block(c);
    }
    c->reading = c->until == 0;
    c->until = (c->reading ? c->every : c->until) - 1;
    if (!c->reading && !read_last) {
        return;
    }

    // the end of the time after an interval that was read, the beginning of one that is
    c->started = hn_clock_ticks();
    const double between = c->started - c->stopped;
    if (c->cpu_stopped > 0) {
        c->cpu_mark += hn_clock_thread() - c->cpu_stopped;
        c->cpu_stopped = 0;
    } else {
        c->between += read_last && between > 0 && between < c->pause ? between : 0;
    }
}

void hn_step_clock_stop(hn_step_clock *c) {
    c->n++;
    if (!c->reading) {
        return;
    }
    c->stopped = hn_clock_ticks();
    c->own += fmax(0, c->stopped - c->started - c->grain);
    c->cpu_stopped = c->stopped - c->started > c->pause ? hn_clock_thread() : 0;
    if (++c->n_read == BLOCK) {
        c->seconds += calc_block(c);
        c->n = 0;
    }
}

// The block that is not full yet is read by the counter's own pace, which is known to a few per
// cent: two readings with no step between them are the same number.
double hn_step_clock_read(const hn_step_clock *c) {
    const double tick = LONG_BREAK / c->pause;
    const double own = own_ticks(c) * tick;
    return c->seconds + (c->n > 0 ? fmin(own, used_cpu(c)) : 0);
}
