// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_STEP_CLOCK_H
#define HN_STUDY_STEP_CLOCK_H
// CPU time of the steps alone, of a run that also checks and samples between its steps. The CPU
// clock of a thread is a call into the kernel and takes as long as a small mechanism's step, so it
// is read once for a block of intervals. The processor's counter, which needs no such call, says
// which share of the block the steps took. If intervals are so short that reading the counter
// twice in each would show, it is read in one interval of SPARSE. After a long interval, which may
// have waited for another process, the CPU clock is read too: what the thread does until the next
// interval then counts for nobody here.

#include <stdbool.h>

typedef struct hn_step_clock {
    double seconds; ///< CPU time of the blocks that have ended [s]
    double grain;   ///< what one pair of readings adds to an interval [ticks]
    double pause;   ///< a longer time between two intervals is the caller's [ticks]

    double cpu_mark;         ///< CPU clock at the beginning of the present block [s]
    double started, stopped; ///< counter at the ends of the last interval [ticks]
    double cpu_stopped;      ///< CPU clock at the end of a long one [s]; 0: it was not read
    double wall_mark, mark;  ///< wall clock [s] and counter then
    double own, between;     ///< in the block's intervals that are read, and after them [ticks]
    int n;                   ///< intervals of the block; 0: the next one opens a block
    int n_read;              ///< of them, those in which the counter was read
    int every;               ///< it is read in one interval of so many
    int until;               ///< intervals until the next one in which it is read
    bool reading;            ///< it is read in the present or last interval
} hn_step_clock;

/// Measures the grain, and starts from zero.
void hn_step_clock_create(hn_step_clock *c);

/// Starts from zero; keeps the grain.
void hn_step_clock_clear(hn_step_clock *c);

/// The clock counts the time between a start and the next stop.
void hn_step_clock_start(hn_step_clock *c);
void hn_step_clock_stop(hn_step_clock *c);

/// Returns the CPU time counted so far [s], the present block included.
double hn_step_clock_read(const hn_step_clock *c);
#endif
