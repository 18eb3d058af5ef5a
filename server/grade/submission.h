// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SUBMISSION_H
#define HN_GRADE_SUBMISSION_H
// The shape of a submission. Each function returns 0 after it has made the verdict ungradable.

#include "grade/verdict.h"

#include <cjson/cJSON.h>

/// Makes the verdict ungradable, with a reason and what to do; returns 0. `hint` may be NULL.
int hn_submission_refuse(hn_verdict *v, const char *hint, const char *format, ...) HN_PRINTF(3, 4);
/// Adds a remark to the verdict's note.
void hn_submission_remark(hn_verdict *v, const char *format, ...) HN_PRINTF(2, 3);
/// Remarks on all members that are not read. `fields`: the names of those that are.
void hn_submission_remark_unread(hn_verdict *v, const cJSON *root, const char *const *fields,
                                 int n);
/// Remarks on formulas that were not written in the spelling of the exercise: the first one as it
/// Remarks that nothing says whose variant was answered.
void hn_submission_remark_nobody(hn_verdict *v);
/// was read, and how many more there are.
void hn_submission_remark_read_as(hn_verdict *v);
/// Refuses a field that says which variant or exercise is answered, or what it cost, and is there
/// twice with different values. `fields`: names of such fields, up to NULL.
int hn_submission_check_once(hn_verdict *v, const cJSON *root, const char *const *fields);
/// Makes a verdict ungradable whose submission names another student than `name`; a submission
/// without a name is everybody's.
void hn_submission_check_student(hn_verdict *v, const char *name);
/// Checks fields and shape. `answer` receives the list of rows, `transposed` whether its shape is
/// that of the transposed matrix.
int hn_submission_read(hn_verdict *v, const cJSON *root, const cJSON **answer, int *transposed);
/// A student number, {"student": 4711}, becomes the text "4711" in `root`. Refuses what is no name:
/// a list, an object, true or false, a number that is not whole; and an empty text unless `chosen`
/// (the caller says whose variant it is). Returns 0 when refused or out of memory.
int hn_submission_read_student(hn_verdict *v, cJSON *root, bool chosen);
#endif
