// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_COUNTED_ANGLES_H
#define HN_CLASS_COUNTED_ANGLES_H
// A part that is right for angles that are counted otherwise than the scene counts them.

#include "session/export/exam.h"

#include <stdbool.h>

/// A part at all states: entry i at state k is given[k * exam->size[part] + i].
typedef struct hn_given_part {
    const hn_export_exam *exam;
    hn_export_part part;
    const double *given;
    double allowed; ///< difference that rounding explains
} hn_given_part;

enum { HN_COUNTED_ANGLES_TEXT = 200 };

/// Writes "it takes theta_2 for an angle against theta_1: ...". A part that is the same at every
/// state is not explained: a number alone fits too much. *found: whether that is all that is wrong.
/// Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_counted_angles_find(const hn_given_part *p, bool *found,
                                               char out[HN_COUNTED_ANGLES_TEXT]);

#endif
