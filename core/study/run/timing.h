// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_TIMING_H
#define HN_STUDY_TIMING_H
// The CPU time of a run: samples, each a batch of runs that is long against the resolution of the
// clock, and their statistics.

#include "study/run/walk.h"

#define HN_TIMING_BATCH 0.02 ///< shortest sample [s]

/// One batch of whole runs to T, straight through: CPU seconds of one of them, and the batch's wall
/// over CPU time in *load. `first_cpu` is what one takes, about [s]. Returns 0 when stopped, or
/// when a run failed.
int hn_timing_batch(hn_run *run, double T, double first_cpu, const hn_walk_limits *limits,
                    double *seconds, double *load);
/// Sorts the list. A quantile of a sorted one, by linear interpolation between its members.
void hn_timing_sort(double *list, int n);
double hn_timing_quantile(const double *sorted, int n, double share);
#endif
