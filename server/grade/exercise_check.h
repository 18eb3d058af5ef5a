// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_EXERCISE_CHECK_H
#define HN_GRADE_EXERCISE_CHECK_H
// Proves an exercise over many seeds: every variant can be drawn, its reference is confirmed by a
// second means and gets full marks, and every listed mistake is named.

#include "grade/exercise.h"

/// What was seen of one part; of a matrix of formulas in the first.
typedef struct hn_answer_spread {
    long long n; ///< right answers that are numbers, or entries of one; 0: something else is asked
    double low, high;
    long long measured; ///< variants in which the difference of both means was measured
    double apart;       ///< the largest of these differences, a share of the value
} hn_answer_spread;

typedef struct hn_exercise_report {
    long long variants, bad;
    long long distinct;       ///< variants with numbers of their own
    long long rights, faults; ///< right answers and wrong answers that were graded
    hn_answer_spread spread[HN_GRADE_MAX_PARTS]; ///< by part
    /// draws that were refused, by the first condition that did not hold
    long long refused[HN_DRAW_CONDITIONS];
    char first[2 * HN_GRADE_TEXT]; ///< the first fault found, "" if none: seed, part, what happened
    bool same;   ///< every variant has the same fault, but for its numbers and letters
    bool varied; ///< numbers or letters of the fault differ from variant to variant
    /// for each bad variant, as long as there is room: its seed, part, and the first thing that
    /// happened; one a line. If `same`, one line for all of them.
    char list[2000];
} hn_exercise_report;

/// Tries seeds from..to of an exercise of form 2. Fails: HN_ERR_MEMORY. What is wrong with the
/// exercise is in the report.
HN_MUST_CHECK hn_status hn_exercise_check(const hn_exercise *exercise, uint64_t from, uint64_t to,
                                          hn_exercise_report *out);
#endif
