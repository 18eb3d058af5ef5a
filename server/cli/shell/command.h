// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COMMAND_H
#define HN_CLI_COMMAND_H
// One command of the command line, and the exit statuses: the same for all commands.

#include "session/model/library.h"

/// Exit statuses: the same everywhere.
typedef enum hn_exit {
    HN_EXIT_DONE = 0,    ///< also a wrong answer that was graded low
    HN_EXIT_INPUT = 2,   ///< the input is at fault
    HN_EXIT_PROGRAM = 3, ///< the program is at fault
    /// a run ended early and said why, a prediction failed, or regrade found another score
    HN_EXIT_ENDED = 4
} hn_exit;

struct hn_args;

typedef struct hn_command {
    const char *name, *words, *about; ///< words: as in the usage line, "SCENE"
    const char *options; ///< names, separated by spaces; "--format=csv|json" where it has choices
    int min_words, max_words;
    /// NULL: a command that speaks of the commands themselves (cli.c)
    hn_exit (*run)(const hn_library *lib, const struct hn_args *args);
} hn_command;
#endif
