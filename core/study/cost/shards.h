// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SHARDS_H
#define HN_STUDY_SHARDS_H
// A study in parts that several processes or machines can take: every point belongs to one part, by
// a rule that knows the request and nothing of a clock, so that whoever splits it splits it alike.
//
// The dearest point first, each to the part that has least to do so far (longest processing time
// first, R. L. Graham, SIAM J. Appl. Math. 17 (1969) 416: the longest part is at most 4/3 of the
// shortest possible). The cost of a point is an estimate from its steps and stages; a poor one
// makes parts unequal, never wrong.

#include "study/cost/workprecision.h"

/// More parts than points would leave some of them without work.
enum { HN_WP_SHARDS = HN_WP_METHODS * HN_WP_LEVELS };

/// Computing time that a point and its samples may take, in seconds of no particular machine.
double hn_wp_expected_seconds(const hn_wp *wp, int m, int k);
/// The part, 1..n, of every point: shard[m * n_levels + k]. n: 1..HN_WP_SHARDS.
void hn_wp_split(const hn_wp *wp, int n, int *shard);
#endif
