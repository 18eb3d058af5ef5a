// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_MANUAL_H
#define HN_CLI_MANUAL_H
// The manual page holonom(1), from the same tables as the help.

#include "cli/shell/commands.h"

/// `holonom manual`: the page in roff on standard output, for `man -l -` and `make install`.
hn_exit hn_command_manual(const hn_library *lib, const hn_args *args);
#endif
