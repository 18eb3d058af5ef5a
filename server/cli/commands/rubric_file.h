// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_RUBRIC_FILE_H
#define HN_CLI_RUBRIC_FILE_H
// The rubric that --rubric names.

#include "cli/shell/args.h"
#include "grade/exercise.h"

/// Puts the rubric of --rubric, if there is one, into the exercise. Fails: HN_ERR_IO, HN_ERR_INPUT,
/// HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_cli_apply_rubric(const hn_args *args, hn_exercise *exercise,
                                            hn_diags *diags);
#endif
