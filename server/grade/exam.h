// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_EXAM_H
#define HN_GRADE_EXAM_H
// An exam: the expressions of an exercise, and the random states at which answers are compared.

#include "expr/graph.h"
#include "grade/exercise.h"

enum { HN_GRADE_MAX_STATES = 64 };

/// The expressions of a problem in a graph of their own, and its states. Freed by hn_exam_reset().
typedef struct hn_exam {
    const hn_exercise *problem;
    hn_graph *graph;
    int symbol[HN_GRADE_MAX_NAMES];
    hn_ex phi[HN_GRADE_MAX_ROWS];
    hn_ex reference[HN_GRADE_MAX_ENTRIES]; ///< row-major, d phi_i / d by_j
    int n_states;                          ///< the first problem->n_closed of them close the loop
    double state[HN_GRADE_MAX_STATES][HN_GRADE_MAX_NAMES];
    double expected[HN_GRADE_MAX_ENTRIES][HN_GRADE_MAX_STATES];
    double size[HN_GRADE_MAX_ENTRIES]; ///< largest |expected| of the entry over the states
} hn_exam;

/// Parses and differentiates phi, draws the states. `diag` may be NULL.
/// Fails: HN_ERR_INPUT (the exercise itself is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_exam_init(hn_exam *exam, const hn_exercise *problem, uint64_t seed,
                                     hn_diag *diag);
void hn_exam_reset(hn_exam *exam);
/// The problem's name that a name of an answer stands for, borrowed; NULL: none.
const char *hn_exam_name(const hn_exam *exam, const char *name);
/// One formula in the problem's names (aliases too).
HN_MUST_CHECK hn_status hn_exam_parse(hn_exam *exam, const char *text, hn_ex *out, hn_diag *diag);
double hn_exam_value(hn_exam *exam, hn_ex e, int state);
/// Returns the difference allowed in an entry whose largest value over the states is `size`.
/// One number for all states: where the entry crosses zero, a rounded constant such as 3.141593
/// errs by as much as elsewhere.
double hn_exam_allowed(const hn_exam *exam, double size);
#endif
