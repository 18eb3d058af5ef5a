// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_ROSTER_H
#define HN_CLASS_ROSTER_H
// A class's submissions, found in a folder as teaching platforms export them: one folder, one file
// or one zip archive for each student.
//
//   Moodle            Ada Lovelace_4711_assignsubmission_file_/answer.json, or the same as one file
//   Canvas            lovelaceada_LATE_4711_9999_answer.json
//   Gradescope        submission_4711/answer.json; submission_metadata.yml beside it has the names
//   GitHub Classroom  exercise-ada/answer.json
//   anything else     the name of the folder, or of the file without its ending

#include "base/diag.h"
#include "base/strbuf.h"

#include <stdbool.h>

enum { HN_ROSTER_NAME = 80, HN_ROSTER_PATH = 1024, HN_ROSTER_BYTES = 1 << 20 };

/// The kind of submissions of a class.
typedef enum hn_roster_kind {
    HN_ROSTER_ANSWERS, ///< .json
    HN_ROSTER_PROGRAMS ///< .py, .c, .cpp, .java, .m, .jl
} hn_roster_kind;

typedef struct hn_roster_entry {
    char student[HN_ROSTER_NAME];
    char path[HN_ROSTER_PATH]; ///< of the folder or the file
    bool is_folder;
} hn_roster_entry;

typedef struct hn_roster {
    int n, cap;
    hn_roster_entry *entry; ///< sorted by student, then path
} hn_roster;

/// Lists every entry of a folder, also those that cannot be graded; hidden files and what platforms
/// and systems add are left out. Fails: HN_ERR_INPUT (no folder, nobody in it, a path too long),
/// HN_ERR_MEMORY. hn_roster_reset() in any case.
HN_MUST_CHECK hn_status hn_roster_read(hn_roster *r, const char *folder, hn_diag *diag);
void hn_roster_reset(hn_roster *r);
/// Finds the one file of this kind of a student and reads it into `text`; `file` gets its name.
/// Fails, with a sentence for the student in diag: HN_ERR_INPUT (none, several, no archive, a link,
/// another kind of file), HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_roster_load(const hn_roster_entry *e, hn_roster_kind kind,
                                       hn_strbuf *text, char file[HN_ROSTER_PATH], hn_diag *diag);

#endif
