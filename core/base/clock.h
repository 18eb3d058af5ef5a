// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_CLOCK_H
#define HN_BASE_CLOCK_H
// The two clocks of the program, and a counter. Only differences between two readings mean
// anything.

/// Returns the wall clock [s]: monotonic, from some moment in the past.
double hn_clock_wall(void);

/// Returns the CPU time of the calling thread [s]. Compare readings of one thread only.
double hn_clock_thread(void);
/// Returns a counter of the processor that increases at a constant, unknown rate: for ratios of
/// times. Reading it takes a third of the time of reading a clock. On processors without one it is
/// the wall clock in nanoseconds.
double hn_clock_ticks(void);

#endif
