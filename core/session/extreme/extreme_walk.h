// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_WALK_H
#define HN_SESSION_EXTREME_EXTREME_WALK_H
// One run of a point, from its start to its end time, with what is measured on the way.

#include "session/extreme/extreme_internal.h"

/// Runs the point to its time. look->run is NULL and status set when it could not begin.
/// hn_extreme_check_end() in any case.
void hn_extreme_check_begin(hn_extreme_bench *bench, const hn_extreme_point *point, unsigned needs,
                            hn_extreme_check *look);
void hn_extreme_check_end(hn_extreme_check *look);
#endif
