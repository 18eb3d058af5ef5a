// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_FOLLOW_ON_H
#define HN_GRADE_FOLLOW_ON_H
// A follow-on: a number that is wrong only because it was computed, rightly, from the student's own
// wrong answer to an earlier part. The part says how it is computed from earlier answers:
//
//     "answer": "T*c*1000/(2.785*m)", "follows": "T*1000/{c}"       {c}: the answer to part c
//
// It earns all points of the part, or the share that a rubric gives for "follow-on". A 0 that
// follows from a 0 earns nothing.

#include "grade/variant.h"

/// Returns whether a wrong answer to part i, graded in `r`, is right with the earlier answers of
/// the submission, of which one at least is wrong; `r` then says so.
/// v: the verdict on earlier parts.
bool hn_follow_on_find(const hn_variant *x, int i, const cJSON *submission, const hn_verdict *v,
                       hn_part_result *r);
/// Confirms the formula of part i: with the right earlier answers it is the part's own reference,
/// and with other ones it is another number. Fails: HN_ERR_INPUT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_follow_on_prove(const hn_variant *x, int i, hn_diag *diag);
#endif
