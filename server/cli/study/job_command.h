// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_JOB_COMMAND_H
#define HN_CLI_JOB_COMMAND_H
// The commands study, report, extreme and reference: each runs one kind of long job
// (session/kinds/job.h). The options come from the fields of the kind, the files from its forms;
// the text for people is a row of the table in job_command.c.

#include "cli/shell/args.h"
#include "session/kinds/job.h"

#endif
