// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_CLOCK_H
#define HN_BASE_CLOCK_H
// The two clocks of the program. Only differences between two readings mean anything.

/// Returns the wall clock [s]: monotonic, from some moment in the past.
double hn_clock_wall(void);

/// Returns the CPU time of the calling thread [s]. Compare readings of one thread only.
double hn_clock_thread(void);
#endif
