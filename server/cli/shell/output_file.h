// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_OUTPUT_FILE_H
#define HN_CLI_OUTPUT_FILE_H
// Results that go to a file.

#include "cli/shell/args.h"

/// The same into a file; "-" or NULL is standard output.
hn_exit hn_cli_write_file(const hn_args *args, const char *path, hn_strbuf *bytes);
/// Before a computation of minutes whose result goes to `path` (NULL: nowhere): HN_ERR_IO where its
/// folder is not there or takes no files.
HN_MUST_CHECK hn_status hn_cli_check_folder(const char *path, hn_diags *diags);
#endif
