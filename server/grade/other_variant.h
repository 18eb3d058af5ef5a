// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_OTHER_VARIANT_H
#define HN_GRADE_OTHER_VARIANT_H
// Numbers that are wrong because they answer another variant: those of another student, or of the
// exercise as it is printed without a name. Only numbers and vectors are tried, and at least two of
// them must be right in the other variant, all wrong ones but one, and not by chance: numbers that
// are right in many variants prove nothing.

#include "grade/variant.h"

/// Says in the summary of a graded submission whose numbers were handed in: those of an owner of
/// the exercise (exercise.h), of the student's name with other capital letters, or of a small seed.
/// Nothing where no variant fits.
void hn_other_variant_say(const hn_variant *x, const cJSON *submission, hn_verdict *v);
#endif
