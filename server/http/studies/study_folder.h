// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_FOLDER_H
#define HN_HTTP_STUDY_FOLDER_H
// The folder in which unfinished studies and references are kept: studies/ in the folder of runs. A
// study that is asked for again continues there, after the server has ended too.

#include <stdbool.h>
#include <stddef.h>

enum { HN_STUDY_FILES = 64 }; ///< the newest so many files are kept, the others removed

/// Writes the path of the folder into `out`; makes the folder where it is missing, and removes its
/// oldest files. Returns false where `runs` is NULL or the folder cannot be used: then nothing is
/// kept.
bool hn_study_folder_ready(const char *runs, char *out, size_t size);
#endif
