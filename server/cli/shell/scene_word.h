// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_SCENE_WORD_H
#define HN_CLI_SCENE_WORD_H
// From words of the command line to a model.

#include "cli/shell/args.h"
#include "session/model/model.h"

#include <stdbool.h>

/// Loads the scene of a word: a shipped name, a file, or "-", with the settings of --set.
HN_MUST_CHECK hn_status hn_args_load_model(const hn_library *lib, const hn_args *args,
                                           const char *word, bool allow_open, hn_model **out,
                                           hn_diags *diags);
/// NAME=VALUE, several per word when separated by commas. `see` gets each. pointer names the option
/// for messages.
typedef hn_status (*hn_see_assignment)(void *user, const char *name, double value);
HN_MUST_CHECK hn_status hn_assignments_read(const hn_words *words, const char *option,
                                            hn_see_assignment see, void *user, hn_diags *diags);
#endif
