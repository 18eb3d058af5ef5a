// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_OUTPUT_FILE_H
#define HN_CLI_OUTPUT_FILE_H
// Results that go to a file.

#include "base/diag.h"
#include "base/strbuf.h"
#include "cli/shell/args.h"

#include <stdbool.h>

/// Writes and frees the buffer's text: into a file, which is replaced as a whole or left as it was,
/// or to standard output ("-" or NULL). Every result of --out goes this way: a file that is there
/// and differs from `bytes` is kept under the first free name FILE.1, FILE.2, ..., and a note says
/// so; --force replaces it. If the result cannot be written, nothing is left beside it. Returns
/// HN_EXIT_PROGRAM when it cannot be written, or the old file cannot be kept.
hn_exit hn_cli_write_file(const hn_args *args, const char *path, hn_strbuf *bytes);
/// The same without keeping what was there: for a file that is this program's own.
hn_exit hn_cli_replace_file(const hn_args *args, const char *path, hn_strbuf *bytes);
/// Returns whether the file holds these bytes.
bool hn_cli_is_content(const char *path, const hn_strbuf *bytes);
/// Writes a picture as hn_cli_write_file() does, but one that this program drew is replaced: it
/// can be drawn again.
hn_exit hn_cli_write_picture(const hn_args *args, const char *path, hn_strbuf *picture);
/// Before anything is computed whose result goes to `path` (NULL: nowhere; "-" is fine too): fails
/// with HN_ERR_INPUT where its folder is not there or takes no files.
HN_MUST_CHECK hn_status hn_cli_check_folder(const char *path, hn_diags *diags);
/// The same of a command that writes one file: also fails where `path` is a folder.
HN_MUST_CHECK hn_status hn_cli_check_file(const char *path, hn_diags *diags);
/// Refuses an --out that is there and holds another text, unless --force is given: what is written
/// is a beginning that somebody completes, and that work must not be lost. Fails: HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_cli_protect_work(const hn_args *args, const hn_strbuf *text,
                                            hn_diags *diags);
/// Returns 1 when both paths lead to one existing file.
int hn_cli_same_file(const char *a, const char *b);
/// Refuses an --out that is one of the files the command reads: HN_ERR_INPUT. A folder is let
/// through: the command names the files in it.
HN_MUST_CHECK hn_status hn_cli_protect_inputs(const hn_args *args, hn_diags *diags);
#endif
