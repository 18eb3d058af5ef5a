// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SERVER_GRADE_PROBLEM_H
#define HN_SERVER_GRADE_PROBLEM_H
// Inside grade/ only: what a problem file says, and an exam: the problem's expressions and the
// states to compare at.

#include "base/arena.h"
#include "expr/graph.h"
#include "expr/parse.h"
#include "grade/grade.h"

#include <cjson/cJSON.h>

/// A parameter or coordinate: random in [low, high], or a formula of those that closes the loop.
typedef struct hn_grade_name {
    const char *name;
    double low, high;
    const char *formula; ///< NULL: random in every state
} hn_grade_name;

typedef struct hn_grade_pair {
    const char *key, *text;
    double value;
} hn_grade_pair;

struct hn_exercise {
    hn_arena *arena;
    const char *id, *title, *scene, *statement, *lesson, *section, *answer;
    int n_names, n_params; ///< parameters first
    hn_grade_name names[HN_GRADE_MAX_NAMES];
    int n_aliases, n_partial;
    hn_grade_pair
        aliases[HN_GRADE_MAX_NAMES]; ///< key: what people type, text: the name it stands for
    hn_grade_pair partial[HN_GRADE_MAX_NAMES]; ///< key: id of a mistake, value: share of the points
    int n_rows, n_columns;
    const char *phi[HN_GRADE_MAX_ROWS];
    const char *by[HN_GRADE_MAX_COLUMNS];
    double points; ///< for each entry
    uint64_t seed, hash;
    int n_closed, n_open;
    double relative, absolute; ///< allowed difference: absolute + relative * |expected|
    const char *why;           ///< reason for the tolerance
};

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
} hn_exam;

/// Parses, differentiates, draws the states. `diag` may be NULL; HN_ERR_INPUT means the problem
/// itself is at fault.
HN_MUST_CHECK hn_status hn_exam_init(hn_exam *exam, const hn_exercise *problem, uint64_t seed,
                                     hn_diag *diag);
void hn_exam_reset(hn_exam *exam);
/// One formula in the problem's names (aliases too).
HN_MUST_CHECK hn_status hn_exam_parse(hn_exam *exam, const char *text, hn_ex *out, hn_diag *diag);
double hn_exam_value(hn_exam *exam, hn_ex e, int state);
/// The difference allowed where this value is expected.
double hn_exam_allowed(const hn_exam *exam, double expected);

/// Names the mistake in a wrong entry, or "other". `value` holds the values of `given` at all
/// states; `by` receives what the text refers to ("J21") and may stay empty.
typedef struct hn_grade_mistake {
    const char *id, *text; ///< static
    char by[32];
} hn_grade_mistake;
hn_grade_mistake hn_grade_find_mistake(hn_exam *exam, int row, int column, hn_ex given,
                                       const double *value);
/// 1 if the mistake's id is one that verdicts can hold.
int hn_grade_is_mistake(const char *id);

#endif
