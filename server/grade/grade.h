// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_GRADE_H
#define HN_GRADE_GRADE_H
// Grading formulas. An exercise asks for a matrix of formulas (the constraint Jacobian, entry by
// entry); its reference is not typed but differentiated from the exercise's own phi. A submission
// is a JSON file with formulas; each entry is compared with the reference at random states (all
// lengths and angles random, loop closed), and a wrong one is compared with what known mistakes
// would have given, so that the verdict can name the mistake.
//
// Three outcomes are kept apart: graded (however low the score), ungradable (the submission cannot
// be read, and why), and the grader's own failure (an hn_status other than HN_OK).

#include "grade/verdict.h"

/// Grades n bytes of a submission. `seed` chooses the states or the variant (0: the variant that
/// the submission says it answers, else the problem's own). HN_OK for graded and ungradable alike;
/// otherwise the grader failed (HN_ERR_MEMORY, HN_ERR_INTERNAL), or the interrupt of the exercise
/// ended it (HN_ERR_STOPPED). Time and memory are bounded.
HN_MUST_CHECK hn_status hn_grade_json(const hn_exercise *problem, const char *text, size_t n,
                                      uint64_t seed, hn_verdict *out);
/// Grades a file, or standard input ("-", "/dev/stdin"). One that is missing, too large or no
/// regular file is ungradable.
HN_MUST_CHECK hn_status hn_grade_file(const hn_exercise *problem, const char *path, uint64_t seed,
                                      hn_verdict *out);
#endif
