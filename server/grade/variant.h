// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VARIANT_H
#define HN_GRADE_VARIANT_H
// One variant of an exercise: its numbers drawn from a seed, and its grading. Its text:
// variant_text.h.

#include "grade/verdict.h"

typedef struct hn_variant {
    const hn_exercise *exercise; ///< borrowed
    uint64_t seed;
    bool chosen;         ///< the seed is not the exercise's own
    const char *student; ///< borrowed; whose seed it is, said in the text; NULL: nobody's
    hn_draw draw;
    int n_parts;
    hn_part part[HN_GRADE_MAX_PARTS];
} hn_variant;

/// Draws the numbers of an exercise of form 2. seed 0: the exercise's own.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY. hn_variant_reset() in any case.
HN_MUST_CHECK hn_status hn_variant_init(hn_variant *x, const hn_exercise *exercise, uint64_t seed,
                                        hn_diag *diag);
void hn_variant_reset(hn_variant *x);
/// The seed of a student's variant: the same for every spelling of a name (student_name.h), never
/// 0.
uint64_t hn_variant_seed(const hn_exercise *exercise, const char *student);
/// The seed that a submission says it answers, by its "seed" or its "student"; 0: it says none.
uint64_t hn_variant_seed_said(const hn_exercise *exercise, const cJSON *submission);
/// Refuses a submission with a seed and a student's name of which each says another variant: false,
/// with the reason in the verdict.
bool hn_variant_check_names(const hn_exercise *exercise, const cJSON *submission, hn_verdict *v);
/// Grades a submission, an object with a member for each part, into the verdict.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY, HN_ERR_STOPPED (its interrupt).
HN_MUST_CHECK hn_status hn_variant_grade(hn_variant *x, const cJSON *submission, hn_verdict *v,
                                         hn_diag *diag);
#endif
