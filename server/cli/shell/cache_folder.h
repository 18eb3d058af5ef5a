// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_CACHE_FOLDER_H
#define HN_CLI_CACHE_FOLDER_H
// The folder for references and unfinished work.

#include "cli/shell/args.h"

/// Returns HOLONOM_CACHE, or holonom in the user's folder for cached files, in `out`; made when it
/// is not there. NULL, with a line on standard error, when there is none.
const char *hn_cache_folder(const hn_args *args, char out[400]);
/// The same without a word on standard error; false where there is none.
bool hn_cache_folder_find(char out[400]);
#endif
