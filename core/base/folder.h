// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_FOLDER_H
#define HN_BASE_FOLDER_H
// Lists the files of a folder, on the disk or inside the program (bundle.h).

#include "base/status.h"

#include <stdbool.h>

/// Names of the files and folders in a folder, hidden ones left out, in the order of their bytes.
typedef struct hn_folder {
    int n;
    char **names;
} hn_folder;

/// Fails: HN_ERR_IO (no such folder), HN_ERR_MEMORY; nothing is left to free then.
HN_MUST_CHECK hn_status hn_folder_read(const char *path, hn_folder *out);
void hn_folder_reset(hn_folder *f); ///< frees the names
bool hn_folder_exists(const char *path);

#endif
