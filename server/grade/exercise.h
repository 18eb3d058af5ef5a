// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_EXERCISE_H
#define HN_GRADE_EXERCISE_H
// An exercise, as its file says: statement, ranges of all names, and what is asked. There are two
// forms of files. "problem": 1 asks for a matrix of formulas, the constraint Jacobian, entry by
// entry. "exercise": 2 has parts, each with its kind of answer (parts/part.h), and numbers that are
// drawn from a seed.

#include "base/arena.h"
#include "base/diag.h"
#include "base/strbuf.h"
#include "grade/contents.h"
#include "grade/parts/part.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    HN_GRADE_MAX_ROWS = 4,
    HN_GRADE_MAX_COLUMNS = 8,
    HN_GRADE_MAX_ENTRIES = HN_GRADE_MAX_ROWS * HN_GRADE_MAX_COLUMNS,
    HN_GRADE_MAX_NAMES = 24,      ///< parameters and coordinates of a problem
    HN_GRADE_MAX_BYTES = 1 << 20, ///< of a submission
    HN_GRADE_MAX_FORMULA = 2000,  ///< characters of one entry
    HN_GRADE_TEXT = 400,
    HN_GRADE_MAX_PARTS = HN_CONTENTS_PARTS,
    HN_GRADE_MAX_HINTS = 8,
    HN_LETTERS = 2 ///< counts up when options are dealt in another order; verdicts hold it
};

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

/// A student and the variant of an exercise that this student has.
typedef struct hn_variant_owner {
    uint64_t seed;
    const char *name; ///< borrowed; NULL: nobody in particular
} hn_variant_owner;

typedef struct hn_exercise {
    hn_arena *arena;
    const char *id, *title, *scene, *statement, *lesson, *section, *answer;
    const char *text;      ///< the file, for the lines of faults
    const char *file;      ///< borrowed; where it was read, as the caller named it; NULL: by its id
    int n_names, n_params; ///< parameters first
    hn_grade_name names[HN_GRADE_MAX_NAMES];
    int n_aliases, n_partial;
    /// key: what people type, text: the name it stands for
    hn_grade_pair aliases[HN_GRADE_MAX_NAMES];
    /// key: id of a mistake, value: share of the points
    hn_grade_pair partial[HN_GRADE_MAX_NAMES];
    int n_rows, n_columns;
    const char *phi[HN_GRADE_MAX_ROWS];
    const char *by[HN_GRADE_MAX_COLUMNS];
    double points; ///< for each entry
    uint64_t seed, hash;
    int n_closed, n_open;
    double relative, absolute; ///< of an entry of the matrix: hn_value_allowed()
    const char *why;           ///< reason for the tolerance
    // form 2
    cJSON *root;                       ///< owned: parts are read where they are used
    int n_parts;                       ///< 0: form 1
    hn_part parts[HN_GRADE_MAX_PARTS]; ///< without a draw
    hn_contents contents;              ///< hashes of the file's members
    int n_hints;
    const char *hints[HN_GRADE_MAX_HINTS];
    int n_owners;                   ///< of a class: whose numbers a wrong answer may be
    const hn_variant_owner *owners; ///< borrowed
    const hn_library *lib;          ///< scenes that parts run; NULL: none
    hn_interrupt interrupt;         ///< ends a grading early: HN_ERR_STOPPED
    bool first_letters; ///< options in the order of letters 1, for verdicts that were made with it
    struct hn_rubric *rubric; ///< owned; NULL: the exercise's own points and shares
} hn_exercise;

/// Reads an exercise (lessons/NN-topic/problems/ID.json). Returns owned.
/// Fails: HN_ERR_IO, HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_MEMORY; diags say where.
HN_MUST_CHECK hn_status hn_exercise_load_file(const char *path, hn_exercise **out, hn_diags *diags);
HN_MUST_CHECK hn_status hn_exercise_load_json(const char *text, size_t n, hn_exercise **out,
                                              hn_diags *diags);
void hn_exercise_free(hn_exercise *problem); ///< NULL is legal
/// The line of the file on which the value of a JSON pointer stands, or the deepest one on the way
/// to it. part >= 0: the pointer is that of a fault of this part, "/parts/answer" for its answer.
int hn_exercise_line(const hn_exercise *problem, int part, const char *pointer);
const char *hn_exercise_id(const hn_exercise *problem);
const char *hn_exercise_title(const hn_exercise *problem);
/// Returns the id of the scene that draws a state of it, "" if there is none.
const char *hn_exercise_scene(const hn_exercise *problem);
double hn_exercise_points(const hn_exercise *problem);
/// Returns whether a drawn number is marked "hidden": true, because it would give an answer away;
/// it is then not among the numbers of a variant.
bool hn_exercise_is_hidden(const hn_exercise *problem, const char *name);
#endif
