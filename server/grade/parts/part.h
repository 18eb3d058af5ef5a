// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PART_H
#define HN_GRADE_PART_H
// A part of an exercise: one question with one kind of answer. The kinds are rows of one table;
// each row is one file part_*.c
// (part_list.h). A part is read from its JSON node where it is used: the exercise
// has been tried as a whole when it was loaded (exercise_check.h).

#include "base/interrupt.h"
#include "grade/parts/draw.h"
#include "scene/scene.h"
#include "session/model/library.h"

#include <stdbool.h>

enum { HN_PART_TEXT = 400, HN_PART_RESULTS = 16, HN_PART_READ_AS = 100 };

/// The result of one entry of an answer.
typedef struct hn_part_result {
    char name[32]; ///< "" for an answer of one entry, else "2", "12"
    double share;  ///< of the points of this entry, 0 .. 1
    double alone;  ///< the share that this mistake earns without a second one beside it
    int right, unreadable;
    bool likely;         ///< the mistake explains the answer, but chance may do so as well
    uint64_t likeness;   ///< equal for equal wrong answers, whatever the variant; 0: says nothing
    const char *mistake; ///< id: static, or borrowed from the exercise; "" when right
    char explanation[HN_PART_TEXT], given[HN_PART_TEXT], expected[HN_PART_TEXT];
    char read_as[HN_PART_READ_AS]; ///< the formula as it was read; "": as it was written
} hn_part_result;

typedef struct hn_part {
    const cJSON *node; ///< borrowed from the exercise
    const struct hn_part_kind *kind;
    const char *id;
    double points;
    uint64_t seed;         ///< of the variant
    uint64_t letters;      ///< the seed of the order of options and of reasons
    hn_draw *draw;         ///< the numbers of the variant
    const hn_library *lib; ///< shipped scenes; NULL: kinds that run mechanisms cannot grade
    /// Long work asks it, and then ends with any result: the caller asks again, and drops that.
    hn_interrupt interrupt;
} hn_part;

/// A scene in the state that an answer describes, for a picture.
enum { HN_PART_ENTRIES = 24, HN_PART_TRACE = 460 };
typedef struct hn_part_view {
    const char *scene; ///< borrowed from the exercise; NULL: there is nothing to draw
    int n_settings, n_entries;
    hn_setting settings[HN_PART_ENTRIES];
    char names[HN_PART_ENTRIES][32];                          ///< of coordinates
    double given[HN_PART_ENTRIES], expected[HN_PART_ENTRIES]; ///< [m], [rad]
    bool overlay; ///< `expected` is set: another pose than the one given
    int n_trace;  ///< points of lines to draw (3 each, world [m]; NaN: a new line begins)
    double trace[3 * HN_PART_TRACE];
} hn_part_view;

typedef enum hn_figure_form {
    HN_FIGURE_TEXT, ///< character cells
    HN_FIGURE_PAGE, ///< SVG in the colours and the font of the page around it
    HN_FIGURE_FILE  ///< SVG by itself, in the lettering of the other pictures
} hn_figure_form;

typedef struct hn_part_kind {
    const char *name;
    const char *fields; ///< members of a node of this kind, separated by blanks
    bool is_open;       ///< many answers are right: the one that is expected is an example
    /// One line: how to write the answer.
    void (*ask)(hn_strbuf *b, const hn_part *p);
    /// Grades an answer (NULL: none was handed in). Fails: HN_ERR_INPUT (the exercise is at fault),
    /// HN_ERR_MEMORY.
    hn_status (*grade)(const hn_part *p, const cJSON *given, hn_part_result *results, int *n,
                       hn_diag *diag);
    /// An answer to fill in (blank.h), owned.
    cJSON *(*blank)(const hn_part *p);
    /// A right answer, owned; NULL when it cannot be made.
    cJSON *(*right)(const hn_part *p, hn_diag *diag);
    /// The i-th wrong answer that must be named, owned, and the id of its mistake; NULL after the
    /// last.
    cJSON *(*fault)(const hn_part *p, int i, const char **id, hn_diag *diag);
    /// Confirms the reference by a second means; NULL: the grading itself proves it.
    hn_status (*prove)(const hn_part *p, hn_diag *diag);
    /// The figure that the question is about; NULL: the kind has none.
    void (*figure)(hn_strbuf *b, const hn_part *p, hn_figure_form form);
    /// Fills in the content of a picture of an answer that can be read; NULL: the kind has none.
    /// The names of settings are borrowed from the exercise.
    void (*view)(const hn_part *p, const cJSON *given, hn_part_view *out);
} hn_part_kind;

// ---- for the kinds ----

/// Fills a result: wrong, with a mistake and a sentence. `share` of the points is given for it.
void hn_part_wrong(hn_part_result *r, const char *mistake, double share, const char *format, ...)
    HN_PRINTF(4, 5);
/// Fills a result for an answer that cannot be read.
void hn_part_unreadable(hn_part_result *r, const char *format, ...) HN_PRINTF(2, 3);
void hn_part_right(hn_part_result *r);
/// Begins the one result of an answer: what was handed in, and what is expected. False, with the
/// result complete, when nothing was handed in.
bool hn_part_begin(hn_part_result *r, int *n, const cJSON *given, const char *expected);
/// Begins the sentence of a mistake that chance may explain with "probably this mistake:", unless
/// two entries show the same mistake.
void hn_part_qualify(hn_part_result *results, int n);
/// The member of an answer with this name, or else the first one in another spelling of it (θ2,
/// theta_2 for th2); NULL: none.
const cJSON *hn_part_member(const cJSON *answer, const char *name);
/// How many numbers the answer is, where it is a list of numbers; otherwise 0.
int hn_part_numbers_asked(const hn_part *p);
/// The i-th object of "faults"; NULL after the last.
const cJSON *hn_part_fault_at(const hn_part *p, int i);
const char *hn_part_text(const cJSON *node, const char *key); ///< "" when there is none
double hn_part_number(const cJSON *node, const char *key, double otherwise);
/// Keeps the answer as the student wrote it in r->given.
void hn_part_keep_given(hn_part_result *r, const cJSON *given);
/// `right` of a kind whose "answer" is a submission as it stands.
cJSON *hn_part_right_answer(const hn_part *p, hn_diag *diag);
/// `fault` of a kind whose faults have such an "answer" too.
cJSON *hn_part_fault_answer(const hn_part *p, int i, const char **id, hn_diag *diag);
/// The message without "part ID: " at its head, for lines that name the part themselves.
const char *hn_part_without_name(const char *id, const char *message);
#endif
