// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_EXAM_ANGLES_H
#define HN_SESSION_EXPORT_EXAM_ANGLES_H
// Parts of an exam as they are where angles are counted from others: relative angles in place of
// absolute ones, and the reverse. Every part follows the angles, as the chain rule asks.

#include "session/export/exam.h"

/// Another way to count angles. `chain`: those from `first` to `last`, each from the one before it;
/// otherwise `last` alone, from `first`.
typedef struct hn_exam_angles {
    bool chain;
    bool included;   ///< the angles include those that the scene counts them from
    int first, last; ///< coordinates
} hn_exam_angles;

/// Lists the ways that are possible in a scene whose coordinates are plain numbers. Returns their
/// number, at most `most`; 0 in a large scene, where there are too many.
int hn_exam_angles_list(const hn_export_exam *exam, hn_exam_angles *out, int most);
/// Writes a part at state k, exam->size[part] numbers, with the angles counted that way.
/// Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_exam_angles_apply(const hn_export_exam *exam, hn_export_part part,
                                             const hn_exam_angles *angles, int k, double *out);
/// Returns the name of a coordinate as the exported programs spell it.
const char *hn_exam_coordinate_name(const hn_export_exam *exam, int i);

#endif
