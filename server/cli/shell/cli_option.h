// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_OPTION_H
#define HN_CLI_OPTION_H
// The table of options of all commands, and which of them a command reads. args.h reads their
// values.

#include "cli/shell/command.h"

#include <stdbool.h>
#include <stddef.h>

enum { HN_CLI_MAX_OPTIONS = 128 };

typedef enum hn_cli_option_kind {
    HN_CLI_FLAG,
    HN_CLI_TEXT,
    HN_CLI_NUMBER,
    HN_CLI_COUNT,   ///< a whole number from 0
    HN_CLI_NUMBERS, ///< separated by commas
    HN_CLI_WORD,    ///< may be repeated
    HN_CLI_WORDS    ///< all words up to the next option
} hn_cli_option_kind;

typedef struct hn_cli_option {
    const char *name, *argument;
    hn_cli_option_kind kind;
    size_t place; ///< in hn_args
    const char *about;
} hn_cli_option;

/// Row i of the table; NULL: there are no more.
const hn_cli_option *hn_cli_option_at(int i);
/// Returns what follows `name` in a list of options: "=csv|json ...", or " ..."; NULL: it is not in
/// it.
const char *hn_cli_option_listed(const char *list, const char *name);
/// Returns whether a command reads an option: those that its row lists, and --json, --help and
/// --no-native.
bool hn_cli_option_is_offered(const hn_command *command, const hn_cli_option *o);
/// Returns whether help, the manual and completion name an option: all that are offered, but --json
/// where a command draws and refuses it with a hint.
bool hn_cli_option_is_shown(const hn_command *command, const hn_cli_option *o);
/// Finds the option of a command by the first n characters of `name`; NULL: it has none.
const hn_cli_option *hn_cli_option_find(const hn_command *command, const char *name, size_t n);
/// Finds --methods where --method was typed, and the other way round: each stands for the other
/// where a command has one of them alone. NULL: `name` is neither, or the command has no other.
const hn_cli_option *hn_cli_option_find_twin(const hn_command *command, const char *name, size_t n);

#endif
