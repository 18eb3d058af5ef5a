// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_EXAMPLES_H
#define HN_CLI_EXAMPLES_H
// Three examples for every command, shown by its help and its manual; the tests run them.

enum { HN_CLI_EXAMPLES = 3 };

/// The example lines of a command, in order of difficulty; NULL: an unknown command.
const char *const *hn_examples_of(const char *command);
#endif
