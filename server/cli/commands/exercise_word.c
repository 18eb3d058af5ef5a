// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/exercise_word.h"

#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "grade/variant.h"

#include <math.h>
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
    (*out)->file = word;
    return HN_OK;
}

bool hn_cli_is_exercise(const hn_library *lib, const char *word) {
    return is_path(word) ? access(word, F_OK) == 0 : hn_library_problem_path(lib, word) != NULL;
}

hn_status hn_cli_check_student(const hn_args *args, hn_diags *diags) {
    return args->student && !args->student[strspn(args->student, " \t\r\n")]
               ? hn_diags_add(diags, HN_ERR_INPUT, "/student", "--student s1001",
                              "--student has no name")
               : HN_OK;
}

uint64_t hn_cli_variant_seed(const hn_args *args, const hn_exercise *exercise) {
    const uint64_t seed = isnan(args->seed) ? 0 : (uint64_t)args->seed;
    if (args->student && seed) {
        hn_cli_note("holonom: --student '%.60s' chooses the variant; --seed is not used\n",
                    args->student);
    }
    return args->student ? hn_variant_seed(exercise, args->student) : seed;
}
