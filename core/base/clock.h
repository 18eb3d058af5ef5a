// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_CLOCK_H
#define HN_BASE_CLOCK_H
// The two clocks of the program, and a counter. Only differences between two readings mean
// anything.

/// Returns the wall clock [s]: monotonic, from some moment in the past.
double hn_clock_wall(void);

/// Returns the CPU time of the calling thread [s]. Compare readings of one thread only.
double hn_clock_thread(void);
/// A counter of the processor that runs on evenly, for shares of a time: its unit is nobody's. It
/// is read in a third of the time that a clock takes; where there is none, the wall clock serves,
/// in nanoseconds.
double hn_clock_ticks(void);

#endif
