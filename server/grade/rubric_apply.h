// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_RUBRIC_APPLY_H
#define HN_GRADE_RUBRIC_APPLY_H
// A rubric and its exercise: checked against each other, put together, and told in words.

#include "grade/exercise.h"
#include "grade/rubric.h"

/// Reports every fault of a rubric that its exercise shows: a part, a mistake or a tolerance that
/// the exercise cannot have; points that do not sum up to "total". Fails: HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_rubric_check(const hn_rubric *r, const hn_exercise *exercise,
                                        hn_diags *diags);
/// Writes the mistakes that each part names by itself, as the ids of "shares".
void hn_rubric_put_mistakes(hn_strbuf *b, const hn_exercise *exercise);
/// Puts the rubric's points and tolerances into the exercise, which owns the rubric from then on.
/// Fails as hn_rubric_check(); the rubric then stays the caller's.
HN_MUST_CHECK hn_status hn_rubric_apply(hn_rubric *r, hn_exercise *exercise, hn_diags *diags);
/// Writes points and tolerances in words, part by part, after hn_rubric_apply().
void hn_rubric_text(hn_strbuf *b, const hn_exercise *exercise);
/// The exercise's own values as a rubric to start from.
void hn_rubric_write(hn_strbuf *b, const hn_exercise *exercise);
#endif
