// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_FORMS_H
#define HN_CLI_FORMS_H
// Writes a job in one of its forms: a file whose name ends in a form's suffix (--out), JSON or CSV
// on standard output (--json, --csv), or text for people.

#include "cli/shell/args.h"
#include "session/kinds/job.h"

typedef void (*hn_text_writer)(hn_strbuf *b, const void *work);

/// Checks --out, --json and --csv before anything is computed. Fails: HN_ERR_INPUT, reported in
/// diags.
HN_MUST_CHECK hn_status hn_forms_check(const hn_job_form *forms, const hn_args *args,
                                       hn_diags *diags);
/// Writes where these options say; into the file first, so that a broken pipe does not cost it.
hn_exit hn_forms_write(const hn_job_form *forms, hn_text_writer text, const hn_args *args,
                       const void *work);
/// Writes to standard output alone. `text` NULL: JSON in place of text.
hn_exit hn_forms_print(const hn_job_form *forms, hn_text_writer text, const hn_args *args,
                       const void *work);
/// 1 when path ends in suffix and has something before it.
int hn_path_ends_in(const char *path, const char *suffix);
#endif
