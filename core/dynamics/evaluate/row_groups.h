#ifndef HN_DYNAMICS_ROW_GROUPS_H
#define HN_DYNAMICS_ROW_GROUPS_H
// How short the shortest row of J is against the longest of its loop and unit. Where all links of a
// loop lie on one line a whole row dies away; a pivot measured against its own row does not see
// that. Down there the pose, known to rounding, decides velocities and accelerations by its last bits:
// a gap of eps moves a row of length s by eps / s, which is eps / s^2 of it.

#include "dynamics/compile/system.h"

#include <stdint.h>

/// Squared lengths of this ratio and below (a row of 3e-5 of the longest): projections leave what
/// the row asks for open. Closing it would turn eps into errors of the velocities of 1e-7 and more,
/// against the 1e-9 of the step itself.
#define HN_ROW_GUARD 1e-9
/// And accelerations do without the row (1e-7 of the longest): its part would be the error of the
/// velocities over 1e-7.
#define HN_ROW_LOST 1e-14
#define HN_ROW_RANK_TOL 1e-4 ///< what counts as lost then, against rows as long as they are

typedef struct hn_row_groups {
    int n;
    int *group;      ///< n: the first row of the same loop and unit
    double *largest; ///< n scratch
} hn_row_groups;

HN_MUST_CHECK hn_status hn_row_groups_init(const hn_system *sys, hn_arena *arena, hn_row_groups *g);
/// Smallest square[slots[i]] against the largest of its group; 1 without rows. Rows that are zero
/// by themselves do not count.
double hn_row_groups_ratio(hn_row_groups *g, const double *square, const uint16_t *slots);

#endif
