// SPDX-License-Identifier: GPL-3.0-or-later
// The help on the options of a command: a head of name and argument, and what is said of it in a
// column of its own.
#ifndef HN_CLI_OPTION_HELP_H
#define HN_CLI_OPTION_HELP_H

#include "cli/shell/args.h"

/// Width of the help [columns]: that of the terminal behind standard output, 80 at most.
int hn_help_width(void);
/// Appends "--set NAME=VALUE   a parameter that differs ...", a line an option of the command.
void hn_args_describe(hn_strbuf *b, const hn_command *command);
/// Appends the description of an option, after its choices where its argument does not list them.
void hn_args_about(hn_strbuf *b, const hn_option_row *o);

#endif
