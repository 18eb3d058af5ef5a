// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/exercise_word.h"

#include "cli/shell/forms.h"

#include <string.h>
#include <unistd.h>

static bool is_path(const char *word) {
    return strchr(word, '/') != NULL || hn_path_ends_in(word, ".json");
}

hn_status hn_cli_load_exercise(const hn_library *lib, const char *word, hn_exercise **out,
                               hn_diags *diags) {
    if (!is_path(word)) {
        return hn_shelf_exercise_load(lib, word, out, diags);
    }
    HN_TRY(hn_exercise_load_file(word, out, diags));
    (*out)->lib = lib;
    return HN_OK;
}

bool hn_cli_is_exercise(const hn_library *lib, const char *word) {
    return is_path(word) ? access(word, F_OK) == 0 : hn_library_problem_path(lib, word) != NULL;
}
