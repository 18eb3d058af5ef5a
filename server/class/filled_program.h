// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_FILLED_PROGRAM_H
#define HN_CLASS_FILLED_PROGRAM_H
// Grades a program that `holonom export SCENE --blanks` wrote and a student has filled in. It runs
// in the sandbox with the argument "states": it reads t, q, v of a state a line, and answers with a
// line of its parts' numbers, which are compared with those of the workbench.

#include "grade/verdict.h"
#include "session/export/exam.h"

typedef struct hn_filled_exam {
    hn_export_exam exam;
    const hn_scene *scene;
    hn_exercise exercise; ///< for verdicts: id, title and points; it has no file
    char title[HN_GRADE_TEXT];
} hn_filled_exam;

/// Works out what is expected of a scene's program. hn_filled_exam_reset() in any case.
/// Fails: as hn_export_exam_init() does; HN_ERR_UNSUPPORTED where the sandbox cannot be set up.
HN_MUST_CHECK hn_status hn_filled_exam_init(hn_filled_exam *f, const hn_model *model,
                                            hn_diags *diags);
void hn_filled_exam_reset(hn_filled_exam *f);
/// Grades a program file, and keeps its name and text in *kept (NULL: nowhere), to which the
/// verdict then points. A program that cannot be started, breaks a limit or answers something
/// else is ungradable, with the reason. Fails: HN_ERR_MEMORY, HN_ERR_IO (no process).
HN_MUST_CHECK hn_status hn_filled_program_grade(const hn_filled_exam *f, const char *path,
                                                hn_graded_program *kept, hn_verdict *v);
/// Grades the text (n bytes) of a program whose file had this name. It stands in a file of its own
/// meanwhile. Fails: as above.
HN_MUST_CHECK hn_status hn_filled_program_grade_text(const hn_filled_exam *f, const char *name,
                                                     const char *text, size_t n, hn_verdict *v);
/// Returns whether a file has the ending of a program that can be graded.
bool hn_filled_program_is(const char *path);

#endif
