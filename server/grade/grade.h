// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SERVER_GRADE_GRADE_H
#define HN_SERVER_GRADE_GRADE_H
// Grading formulas. A problem asks for a matrix of formulas (the constraint Jacobian, entry by
// entry); its reference is not typed but differentiated from the problem's own phi. A submission is
// a JSON file with formulas; each entry is compared with the reference at random states (all
// lengths and angles random, loop closed), and a wrong one is compared with what known mistakes
// would have given, so that the verdict can name the mistake.
//
// Three outcomes are kept apart: graded (however low the score), ungradable (the submission cannot
// be read, and why), and the grader's own failure (an hn_status other than HN_OK).

#include "base/diag.h"
#include "base/strbuf.h"

#include <stdint.h>

enum {
    HN_GRADE_MAX_ROWS = 4,
    HN_GRADE_MAX_COLUMNS = 8,
    HN_GRADE_MAX_ENTRIES = HN_GRADE_MAX_ROWS * HN_GRADE_MAX_COLUMNS,
    HN_GRADE_MAX_NAMES = 24,      ///< parameters and coordinates of a problem
    HN_GRADE_MAX_BYTES = 1 << 20, ///< of a submission
    HN_GRADE_MAX_FORMULA = 2000,  ///< characters of one entry
    HN_GRADE_TEXT = 400
};

typedef struct hn_exercise hn_exercise;

/// Reads a problem (lessons/NN-topic/problems/ID.json). Returns owned. Fails: HN_ERR_IO,
/// HN_ERR_INPUT, HN_ERR_MEMORY, told in diags.
HN_MUST_CHECK hn_status hn_exercise_load_file(const char *path, hn_exercise **out, hn_diags *diags);
HN_MUST_CHECK hn_status hn_exercise_load_json(const char *text, size_t n, hn_exercise **out,
                                              hn_diags *diags);
void hn_exercise_free(hn_exercise *problem); ///< NULL is legal
const char *hn_exercise_id(const hn_exercise *problem);
const char *hn_exercise_title(const hn_exercise *problem);
const char *hn_exercise_scene(
    const hn_exercise *problem); ///< id of the scene that draws a state of it; "" if none
double hn_exercise_points(const hn_exercise *problem);
/// The statement for a person: what is given, what is asked, how to hand it in.
void hn_exercise_text(hn_strbuf *b, const hn_exercise *problem);
/// {"id","title","statement","points","entries":[..],"given":[..],"submission":{..}}
void hn_exercise_json(hn_strbuf *b, const hn_exercise *problem);

/// What became of one entry.
typedef struct hn_entry_verdict {
    char name[32]; ///< "J11"
    int row, column;
    double points, max_points;
    int right;
    int closed_only; ///< right where the loop is closed, though not the derivative as a formula
    const char *
        /// id of a known mistake ("sign", "degrees", ...), "other", or "" when right; static
        mistake;
    char explanation[HN_GRADE_TEXT]; ///< a sentence for the student, "" when right
    char given[HN_GRADE_TEXT];       ///< the formula as handed in, cut
    char expected[HN_GRADE_TEXT];    ///< the reference formula
    int state;                       ///< the state where it shows, -1 if right or unreadable
    double given_value, expected_value, allowed; ///< at that state; meaningless while state is -1
} hn_entry_verdict;

typedef enum hn_verdict_kind { HN_VERDICT_GRADED, HN_VERDICT_UNGRADABLE } hn_verdict_kind;

typedef struct hn_verdict {
    hn_verdict_kind kind;
    char reason[HN_GRADE_TEXT];  ///< ungradable: why, and where
    char hint[HN_GRADE_TEXT];    ///< ungradable: what to do
    char summary[HN_GRADE_TEXT]; ///< one sentence on the whole
    char note[HN_GRADE_TEXT];    ///< fields that were not read, "" if none
    double score, max_score;
    int n_entries, n_right;
    hn_entry_verdict entry[HN_GRADE_MAX_ENTRIES];
    // the state at which the first wrong entry shows, for a picture: names as in the scene,
    // parameters first
    int shown_entry; ///< index of that entry, -1 if there is none
    int n_names,
        n_params; ///< of the n_names, the first n_params are parameters, the rest coordinates
    const char *names[HN_GRADE_MAX_NAMES]; ///< borrowed from the problem
    double values[HN_GRADE_MAX_NAMES];     ///< [m], [rad]
    int n_states;                          ///< states at which entries were compared
    uint64_t seed;
    const hn_exercise *problem; ///< borrowed
} hn_verdict;

/// Grades n bytes of a submission. `seed` chooses the states (0: the problem's own). HN_OK for
/// graded and ungradable alike; otherwise the grader failed (HN_ERR_MEMORY, HN_ERR_INTERNAL). Time
/// and memory are bounded.
HN_MUST_CHECK hn_status hn_grade_json(const hn_exercise *problem, const char *text, size_t n,
                                      uint64_t seed, hn_verdict *out);
/// The same from a file; one that cannot be opened or is too large is ungradable. At most
/// HN_GRADE_MAX_BYTES + 1 are read.
HN_MUST_CHECK hn_status hn_grade_file(const hn_exercise *problem, const char *path, uint64_t seed,
                                      hn_verdict *out);

/// For a person: one line an entry, and under a wrong one given, expected, allowed difference and
/// the kind of mistake.
void hn_verdict_text(hn_strbuf *b, const hn_verdict *v);
/// The whole verdict as one JSON object.
void hn_verdict_json(hn_strbuf *b, const hn_verdict *v);
/// Gradescope's results.json. execution_time [s] is written if >= 0.
void hn_verdict_gradescope(hn_strbuf *b, const hn_verdict *v, double execution_time);

#endif
