// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_VERDICT_NAMES_H
#define HN_CLI_VERDICT_NAMES_H
// Names of the files that verdicts go to: no two submissions share one, and none is a submission.

#include "base/diag.h"
#include "cli/shell/args.h"

typedef struct hn_verdict_names {
    int n;
    char *path[HN_CLI_MAX_WORDS]; ///< without the ending; owned
} hn_verdict_names;

/// Chooses a path in `folder` for each of n submissions and makes the folders.
///
/// The submission's name without its ending, as long as these differ; otherwise with as many of its
/// last folders as tell them apart (a/answer.json, b/answer.json: FOLDER/a/answer,
/// FOLDER/b/answer), and with its own ending where even these are the same. The name of standard
/// input is "submission". `single`: one
/// submission alone is called "results".
/// Fails: HN_ERR_INPUT (a submission given twice, a submission that would be overwritten),
/// HN_ERR_IO (a folder cannot be made), HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_verdict_names_choose(hn_verdict_names *names, const char *folder,
                                                const char *const *submissions, int n,
                                                const char *ending, int single, hn_diags *diags);
void hn_verdict_names_reset(hn_verdict_names *names); ///< a zeroed one is legal
#endif
