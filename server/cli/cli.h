// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_CLI_H
#define HN_CLI_CLI_H
// The command line: one table of commands. Results go to standard output, everything else to
// standard error.

#include "cli/shell/command.h"

int hn_command_count(void);
const hn_command *hn_command_at(int i);

/// Runs the program; returns its exit status.
int hn_cli_main(int argc, char **argv);
#endif
