// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PART_LIST_H
#define HN_GRADE_PART_LIST_H
// The table of all kinds of answers.

#include "grade/parts/part.h"

extern const hn_part_kind hn_part_values, hn_part_choice, hn_part_matrix, hn_part_blocks,
    hn_part_basis, hn_part_example, hn_part_order, hn_part_method, hn_part_reading,
    hn_part_configuration, hn_part_scene;

/// Checks id, kind, points and that every member is known. `node` is the JSON of the part.
HN_MUST_CHECK hn_status hn_part_open(hn_part *p, const cJSON *node, hn_diag *diag);
/// Returns how long a part of this kind takes a student [min], estimated; 0 for an unknown kind.
double hn_part_minutes(const char *kind);
#endif
