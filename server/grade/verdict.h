// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VERDICT_H
#define HN_GRADE_VERDICT_H
// The verdict on one submission, and its three forms: for a person, for a program, for Gradescope.

#include "grade/exercise.h"

enum { HN_VERDICT_KEPT = 16384 };

/// The verdict on one entry.
typedef struct hn_entry_verdict {
    char name[32]; ///< "J11", or a part with its entry: "b.2"
    int n_whole;   ///< bytes of the name that name the matrix or the part: 1 of "J11"
    int row, column;
    double points, max_points;
    int right;
    int closed_only; ///< right where the loop is closed, though not the derivative as a formula
    /// id of a known mistake ("sign", "degrees", ...), "other", or "" when right; static
    const char *mistake;
    char explanation[HN_GRADE_TEXT]; ///< a sentence for the student, "" when right
    char given[HN_GRADE_TEXT];       ///< the formula as handed in, cut
    char expected[HN_GRADE_TEXT];    ///< the reference formula
    char read_as[HN_PART_READ_AS];   ///< the formula as it was read, cut; "": as it was written
    uint64_t likeness; ///< equal for equal wrong answers, whatever the variant; 0: says nothing
    int state;         ///< the state where it shows, -1 if right or unreadable
    double given_value, expected_value, allowed; ///< at that state; meaningless while state is -1
    double at[HN_GRADE_MAX_NAMES]; ///< the state itself, in the order of the verdict's names
} hn_entry_verdict;

/// The program of a scene that was graded: with it the verdict can be made again.
typedef struct hn_graded_program {
    char file[80]; ///< its name, without folders
    hn_strbuf text;
    const char *const *set; ///< "l1=0.45": parameters of the scene that were changed; borrowed
    int n_set;
} hn_graded_program;

typedef enum hn_verdict_kind { HN_VERDICT_GRADED, HN_VERDICT_UNGRADABLE } hn_verdict_kind;

typedef struct hn_verdict {
    hn_verdict_kind kind;
    bool unnamed;                ///< the caller chose the variant, and the file names none
    bool no_submission;          ///< ungradable, and the exercise or the rubric is at fault
    char reason[HN_GRADE_TEXT];  ///< ungradable: why, and where
    char hint[HN_GRADE_TEXT];    ///< ungradable: what to do
    char summary[HN_GRADE_TEXT]; ///< one sentence on the whole
    char note[HN_GRADE_TEXT]; ///< remarks: fields that were not read, slips put right; "" if none
    double score, max_score;
    int n_entries, n_right;
    int n_unreadable; ///< entries whose formula cannot be read
    hn_entry_verdict entry[HN_GRADE_MAX_ENTRIES];
    // the state at which the first wrong entry shows, for a picture: names as in the scene,
    // parameters first
    int shown_entry;                       ///< index of that entry, -1 if there is none
    int n_names, n_params;                 ///< parameters first, then coordinates
    const char *names[HN_GRADE_MAX_NAMES]; ///< borrowed from the problem
    double values[HN_GRADE_MAX_NAMES];     ///< [m], [rad]
    hn_part_view view; ///< of an exercise with parts: the scene of the picture; scene NULL: none
    int n_states;      ///< states at which entries were compared
    uint64_t seed;
    const hn_exercise *problem;       ///< borrowed
    const hn_graded_program *program; ///< in place of `submission`; borrowed, NULL: no program
    bool show_expected; ///< the reference's formulas and numbers are written too: not for students
    char student[80];   ///< whose variant it is; "" when the seed was given
    uint64_t submission_hash;
    char submission[HN_VERDICT_KEPT]; ///< the submission itself, "" when it is longer
} hn_verdict;

/// "graded", "ungradable" (the submission is at fault) or "failed" (exercise or rubric are).
const char *hn_verdict_status(const hn_verdict *v);
/// For a person: one line an entry, and under a wrong one given, expected, allowed difference and
/// the kind of mistake.
void hn_verdict_text(hn_strbuf *b, const hn_verdict *v);
/// The whole verdict as one JSON object.
void hn_verdict_json(hn_strbuf *b, const hn_verdict *v);
/// Gradescope's results.json. execution_time [s] is written if >= 0.
void hn_verdict_gradescope(hn_strbuf *b, const hn_verdict *v, double execution_time);
/// Writes what was handed in for an entry, with its value where that is no number as it stands:
/// "force[0] = 6.475".
void hn_verdict_given(hn_strbuf *b, const hn_entry_verdict *e);
/// Returns whether what is expected stands beside an entry: a wrong one, for a teacher who asked
/// for it.
bool hn_verdict_shows_expected(const hn_verdict *v, const hn_entry_verdict *e);
/// Writes what is expected of a wrong entry: the reference formula, or the value at its state.
void hn_verdict_expected(hn_strbuf *b, const hn_entry_verdict *e);
/// Writes the lines under one entry, each after `indent`; nothing for an entry that is right.
void hn_verdict_entry_text(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e,
                           const char *indent);
#endif
