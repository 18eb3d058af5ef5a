// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COMMAND_TABLE_H
#define HN_CLI_COMMAND_TABLE_H
// The table of commands, one row each. Help, manual and completion are written from it; these
// commands, and the version, have no function in their rows: cli.c has it.

#include "cli/shell/command.h"

/// Returns the number of commands.
int hn_command_count(void);
/// The row of command i, 0 <= i < hn_command_count().
const hn_command *hn_command_at(int i);
/// The row of a name, or NULL.
const hn_command *hn_command_find(const char *name);
#endif
