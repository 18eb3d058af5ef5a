// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_MISTAKES_H
#define HN_GRADE_MISTAKES_H
// Known mistakes: what a wrong entry would look like if the student had made them.

#include "grade/exam.h"

#include <stdbool.h>

/// Names the mistake in a wrong entry, or "other". `value` holds the values of `given` at all
/// states; `by` receives what the text refers to ("J21") and may stay empty.
typedef struct hn_grade_mistake {
    const char *id, *text; ///< static
    char by[32];
    const char *second, *also; ///< a second mistake at once: its id and words; NULL: none
} hn_grade_mistake;
hn_grade_mistake hn_grade_find_mistake(hn_exam *exam, int row, int column, hn_ex given,
                                       const double *value);
/// Returns whether the mistake's id is one that verdicts can hold.
bool hn_grade_is_mistake(const char *id);
#endif
