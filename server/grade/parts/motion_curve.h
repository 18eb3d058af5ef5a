// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_MOTION_CURVE_H
#define HN_GRADE_MOTION_CURVE_H
// A quantity over time, as a run of the program gives it, and what a reader takes from its plot.
//
//     "scene": "four-bar", "set": ["l1"], "method": "index1@rk4:h=0.01", "time": 5,
//     "curve": "gap"       gap, velocity gap, energy, or a coordinate or rate of the scene

#include "grade/parts/part_model.h"

#include <stdbool.h>

enum { HN_CURVE_POINTS = 501 };

typedef struct hn_motion_curve {
    double dt, t_end; ///< [s]
    int n;            ///< values at k * dt
    double y[HN_CURVE_POINTS];
    double low, high; ///< the least and the largest value
    const char *unit; ///< of y, static
} hn_motion_curve;

/// Runs `method` and samples the curve that the part names. Returns HN_ERR_INPUT (the exercise is
/// at fault: the run ends early too), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_motion_curve_make(hn_motion_curve *c, const hn_part *p,
                                             const char *method, hn_diag *diag);

/// A quantity that is read off a curve: one row of a table.
typedef struct hn_curve_reading {
    const char *name;  ///< "largest", as in the exercise
    const char *says;  ///< "the largest value"
    bool is_time;      ///< read on the axis of time
    bool needs_number; ///< a time or a level
    /// NaN where the curve has no such place
    double (*read)(const hn_motion_curve *c, double number);
} hn_curve_reading;
/// The i-th of all readings; NULL after the last.
const hn_curve_reading *hn_curve_reading_at(int i);
const hn_curve_reading *hn_curve_reading_find(const char *name, hn_diag *diag);
#endif
