// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COMMANDS_GRADE_FOLDER_H
#define HN_CLI_COMMANDS_GRADE_FOLDER_H
// holonom grade ID FOLDER: a class, one line a submission; and its parts put together.

#include "class/class_grading.h"
#include "cli/shell/commands.h"

/// The subject of a grading: an exercise of formulas, or the program of a scene.
typedef struct hn_grade_subject {
    const hn_exercise *exercise;     ///< for a program: that of `programs`
    const hn_filled_exam *programs;  ///< NULL: formulas
    const hn_blank_programs *blanks; ///< of a class of programs, else NULL
} hn_grade_subject;

/// Grades every submission of the folder that is the second word.
hn_exit hn_grade_folder(const hn_args *args, const hn_grade_subject *subject);
/// Puts the parts together that --shard made: the words behind the first.
hn_exit hn_grade_merge(const hn_args *args, const hn_grade_subject *subject);

#endif
