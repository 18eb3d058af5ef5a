// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_COMMANDS_H
#define HN_CLI_COMMANDS_H
// The functions behind the commands; each file of commands/ and study/ defines one or a few of
// them.

#include "cli/shell/args.h"

/// A function for each row of command_table.c, which says what it does. Returns the exit code.
hn_exit hn_command_list(const hn_library *lib, const hn_args *args);
hn_exit hn_command_inspect(const hn_library *lib, const hn_args *args);
hn_exit hn_command_terms(const hn_library *lib, const hn_args *args);
hn_exit hn_command_equations(const hn_library *lib, const hn_args *args);
hn_exit hn_command_export(const hn_library *lib, const hn_args *args);
hn_exit hn_command_program(const hn_library *lib, const hn_args *args);
hn_exit hn_command_run(const hn_library *lib, const hn_args *args);
hn_exit hn_command_compare(const hn_library *lib, const hn_args *args);
hn_exit hn_command_reference(const hn_library *lib, const hn_args *args);
hn_exit hn_command_report(const hn_library *lib, const hn_args *args);
hn_exit hn_command_merge(const hn_library *lib, const hn_args *args);
hn_exit hn_command_study(const hn_library *lib, const hn_args *args);
hn_exit hn_command_extreme(const hn_library *lib, const hn_args *args);
hn_exit hn_command_snapshot(const hn_library *lib, const hn_args *args);
hn_exit hn_command_lesson(const hn_library *lib, const hn_args *args);
hn_exit hn_command_problem(const hn_library *lib, const hn_args *args);
hn_exit hn_command_regrade(const hn_library *lib, const hn_args *args);
hn_exit hn_command_rubric(const hn_library *lib, const hn_args *args);
hn_exit hn_command_grade(const hn_library *lib, const hn_args *args);
hn_exit hn_command_import(const hn_library *lib, const hn_args *args);
hn_exit hn_command_tui(const hn_library *lib, const hn_args *args);
hn_exit hn_command_serve(const hn_library *lib, const hn_args *args);
#endif
