// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ROW_GROUPS_H
#define HN_DYNAMICS_ROW_GROUPS_H
// The length of the shortest row of J against the longest of its loop and unit.
//
// If all links of a loop are collinear a whole row of J vanishes, which a pivot measured against
// its own row does not show. There, rounding errors of q dominate velocities and accelerations: a
// gap of eps changes a row of length s by eps / s, which is eps / s^2 of the row.

#include "dynamics/compile/system.h"

#include <stdint.h>

/// At and below this ratio of squared lengths (a row of 3e-5 of the longest) a projection leaves
/// the gap of the row open. Closing it would turn eps into velocity errors of 1e-7 and more,
/// against the 1e-9 of the step itself.
#define HN_ROW_GUARD 1e-9
/// At and below this ratio (1e-7 of the longest) accelerations leave the row out: it would
/// contribute the error of the velocities over 1e-7.
#define HN_ROW_LOST 1e-14
#define HN_ROW_RANK_TOL 1e-4 ///< rank tolerance then, against rows as long as they are

typedef struct hn_row_groups {
    int n;
    int *group;      ///< n: the first row of the same loop and unit
    double *largest; ///< n scratch
} hn_row_groups;

/// Finds the groups of rows of one loop and one unit. Memory from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_row_groups_init(const hn_system *sys, hn_arena *arena, hn_row_groups *g);
/// Returns the smallest square[slots[i]] against the largest of its group; 1 without rows. Rows
/// that are zero by themselves do not count.
double hn_row_groups_ratio(hn_row_groups *g, const double *square, const uint16_t *slots);

#endif
