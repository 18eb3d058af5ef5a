// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_CLI_H
#define HN_CLI_CLI_H
// The command line: finds the command of the first word (command_table.h) and runs it. Results go
// to standard output, everything else to standard error.

/// Runs the program; returns its exit status.
int hn_cli_main(int argc, char **argv);
#endif
