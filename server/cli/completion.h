// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COMPLETION_H
#define HN_CLI_COMPLETION_H
// Lists the words that may come next on a command line. The shells ask the program itself, so
// completion knows every command, option, scene, parameter, method and option of a method that the
// program knows.

#include "cli/shell/commands.h"

/// `holonom completion bash|zsh|fish`: the few lines that a shell needs, on standard output.
hn_exit hn_command_completion(const hn_library *lib, const hn_args *args);
/// Adds a line for each candidate for the last of n words behind `holonom`: "candidate" or
/// "candidate<TAB>what it is". The last part of a list after commas is completed. Returns whether
/// a file may stand there too.
bool hn_completion_candidates(hn_strbuf *b, const hn_library *lib, const char *const *words, int n);
#endif
