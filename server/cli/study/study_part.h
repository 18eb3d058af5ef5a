// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_STUDY_PART_H
#define HN_CLI_STUDY_PART_H
// Part of a work-precision study (--shard): JSON that `holonom merge` reads.

#include "cli/shell/args.h"
#include "session/precision/study.h"

/// Fails: HN_ERR_INPUT, reported in diags: the output options ask for something else than JSON.
HN_MUST_CHECK hn_status hn_part_check(const hn_args *args, hn_diags *diags);
/// Writes the part to its file, or to standard output.
hn_exit hn_write_part(const hn_args *args, const hn_study *study);
#endif
