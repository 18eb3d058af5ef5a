// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_FOLDER_H
#define HN_HTTP_RUN_FOLDER_H
// Finished runs in a folder, one file for each: {"request":...,"documents":[...]}, behind a line
// with its hash. A file is believed only when it is whole. If `folder` is NULL nothing is kept.

#include "http/runs/kept_run.h"

#include <stdbool.h>

/// Keeps a finished run. One that cannot be kept is told on stderr: it can be computed again.
void hn_run_folder_keep(const char *folder, const hn_kept_run *run);
/// Reads the run of an id, with one reference; NULL when there is no whole file of it.
hn_kept_run *hn_run_folder_read(const char *folder, const char *id);
/// Stamp of a file: another stamp, another content.
typedef struct hn_run_stamp {
    long long size, seconds, ns; ///< [byte]; of its last change
    unsigned long long inode;
} hn_run_stamp;

/// Returns false when there is no file of this id.
bool hn_run_folder_stamp(const char *folder, const char *id, hn_run_stamp *out);
/// Calls `see` with the id of every file of the folder that has the name of a run. Whether the file
/// is whole is seen when it is read.
void hn_run_folder_each(const char *folder, void (*see)(void *user, const char *id), void *user);
/// Removes the file of an id. An id without a file is legal.
void hn_run_folder_delete(const char *folder, const char *id);
#endif
