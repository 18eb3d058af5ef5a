// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_EXERCISE_WORD_H
#define HN_CLI_EXERCISE_WORD_H
// The exercise that a word of the command line names: a shipped one by its id, or one of the
// user's own by the path of its file (a word with a slash, or that ends in .json).

#include "cli/shell/args.h"
#include "cli/shell/command.h"
#include "grade/exercise_shelf.h"

#include <stdbool.h>

/// Returns owned in *out. Fails: as hn_shelf_exercise_load(), HN_ERR_IO.
HN_MUST_CHECK hn_status hn_cli_load_exercise(const hn_library *lib, const char *word,
                                             hn_exercise **out, hn_diags *diags);
/// Returns whether the word names a file that is there, or a shipped exercise: what is wrong is
/// then wrong in the exercise, not on the command line.
bool hn_cli_is_exercise(const hn_library *lib, const char *word);
/// Refuses a --student without a name: HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_cli_check_student(const hn_args *args, hn_diags *diags);
/// The seed that --student or --seed chooses; 0: neither does. A student's name goes before a seed,
/// and a note says so.
uint64_t hn_cli_variant_seed(const hn_args *args, const hn_exercise *exercise);
#endif
