// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_EXERCISE_H
#define HN_TUI_EXERCISE_H
// An exercise that is answered in the terminal: its fields, what was typed into them, the hints
// that were asked for, and the verdict of the grader (grade/grade.h) on what was checked last.

#include "grade/verdict.h"

enum { HN_TUI_ANSWER = 256 };

typedef struct hn_tui_exercise hn_tui_exercise;

/// Loads a shipped exercise with the numbers of its own seed. Returns owned in *out; fails as
/// hn_shelf_exercise_load(), and with HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_tui_exercise_create(const hn_library *library, const char *id,
                                               hn_tui_exercise **out, hn_diags *diags);
void hn_tui_exercise_free(hn_tui_exercise *x); ///< NULL is legal
const char *hn_tui_exercise_id(const hn_tui_exercise *x);
/// A field is a part, or an entry of the matrix that is asked for.
int hn_tui_exercise_n_fields(const hn_tui_exercise *x);
const char *hn_tui_exercise_field(const hn_tui_exercise *x, int i); ///< its name
const char *hn_tui_exercise_answer(const hn_tui_exercise *x, int i);
/// Keeps what was typed for a field; what was checked before it no longer holds.
void hn_tui_exercise_set_answer(hn_tui_exercise *x, int i, const char *text);
int hn_tui_exercise_n_hints(const hn_tui_exercise *x); ///< that there are, shown or not
/// Shows one more hint; false: all of them are shown.
bool hn_tui_exercise_show_hint(hn_tui_exercise *x);
/// Grades what was typed. An answer "@FILE" is what the file says. Fails: HN_ERR_IO (such a file,
/// told in diag), or where the grader itself failed.
HN_MUST_CHECK hn_status hn_tui_exercise_check(hn_tui_exercise *x, hn_diag *diag);
/// Returns whether the grader cannot read answer i, and writes why, with the column.
bool hn_tui_exercise_is_unreadable(const hn_tui_exercise *x, int i, char why[HN_GRADE_TEXT]);
/// Writes how many parts of the checked answers are right, and which are partly right.
void hn_tui_exercise_summary(const hn_tui_exercise *x, char out[HN_GRADE_TEXT]);
/// The verdict on the answers as they stand; NULL before the check.
const hn_verdict *hn_tui_exercise_verdict(const hn_tui_exercise *x);
/// Writes everything there is to read, with answers, hints and verdict. *first and *last: the lines
/// of the field `chosen`, from its question to what is said of its answer; *line: that of its
/// answer.
void hn_tui_exercise_text(const hn_tui_exercise *x, int chosen, hn_strbuf *b, int *first, int *line,
                          int *last);
#endif
