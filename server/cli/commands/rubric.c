// SPDX-License-Identifier: GPL-3.0-or-later
// holonom rubric: checks a teacher's rubric against its exercise, or writes one to start from. Exit
// status 2: the rubric is at fault.
#include "base/suggest.h"
#include "cli/commands/exercise_word.h"
#include "cli/commands/rubric_file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/rubric_apply.h"
#include "grade/toml_text.h"

#include <stdbool.h>
#include <string.h>
#include <unistd.h>

/// Loads the exercise that `word` names, or else the rubric itself. A rubric holds the id of an
/// exercise alone: the file of a teacher's own one must be named.
static hn_status load_exercise(const hn_library *lib, const hn_rubric *rubric, const char *word,
                               hn_exercise **e, hn_diags *diags) {
    const char *id = hn_rubric_exercise(rubric);
    if (!word && !hn_cli_is_exercise(lib, id)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/exercise",
                            "name the file of your own exercise: rubric check FILE EXERCISE.json",
                            "no shipped exercise is called '%.80s'", id);
    }
    return hn_cli_load_exercise(lib, word ? word : id, e, diags);
}

/// Every fault of a rubric: of its fields, then those that its exercise shows.
static hn_status load(const hn_library *lib, const char *path, const char *word, hn_rubric **rubric,
                      hn_exercise **e, hn_diags *diags) {
    hn_status status = hn_rubric_load_file(path, rubric, diags);
    if (*rubric) {
        const hn_status own = load_exercise(lib, *rubric, word, e, diags);
        const hn_status fits = own == HN_OK ? hn_rubric_check(*rubric, *e, diags) : own;
        status = status == HN_OK ? fits : status;
    }
    HN_THEN(status, hn_rubric_apply(*rubric, *e, diags));
    hn_rubric_sort_faults(diags);
    hn_diags_name_file(diags, 0, path);
    return status;
}

static hn_exit check(const hn_library *lib, const hn_args *args, const char *path,
                     const char *exercise) {
    hn_rubric *rubric = NULL;
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    const hn_status status = load(lib, path, exercise, &rubric, &e, &diags);
    if (status != HN_OK) {
        hn_exercise_free(e);
        hn_rubric_free(rubric);
        return hn_report_diags(args, status, &diags);
    }
    hn_strbuf_init(&b);
    hn_rubric_text(&b, e);
    hn_rubric_put_mistakes(&b, e);
    hn_exercise_free(e);
    return hn_cli_print_text(&b);
}

/// Returns whether --out is a file with other bytes than these, which may be a teacher's own
/// rubric.
static bool is_someones(const hn_args *args, const hn_strbuf *bytes) {
    const bool file = args->out && strcmp(args->out, "-") != 0;
    return file && !args->force && access(args->out, F_OK) == 0 &&
           !hn_cli_is_content(args->out, bytes);
}

static hn_exit refuse_overwriting(const hn_args *args) {
    hn_diag diag;
    hn_diag_set(&diag, HN_ERR_INPUT, "/out", "choose another name; --force replaces it",
                "'%.200s' is there already and differs from the exercise's own rubric", args->out);
    return hn_report_diag(args, &diag);
}

/// Puts TOML in the place of a rubric in JSON.
static void write_as_toml(hn_strbuf *b) {
    cJSON *root = cJSON_ParseWithLength(hn_strbuf_text(b), b->n);
    hn_strbuf_clear(b);
    b->failed |= !root;
    hn_toml_write(b, root);
    cJSON_Delete(root);
}

static hn_exit write_rubric(const hn_library *lib, const hn_args *args, const char *id) {
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    const hn_status status = hn_cli_load_exercise(lib, id, &e, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    hn_strbuf_init(&b);
    hn_rubric_write(&b, e);
    hn_exercise_free(e);
    if (args->out && hn_rubric_is_toml(args->out)) {
        write_as_toml(&b);
    }
    if (is_someones(args, &b)) {
        hn_strbuf_reset(&b);
        return refuse_overwriting(args);
    }
    return hn_cli_write_file(args, args->out, &b);
}

hn_exit hn_command_rubric(const hn_library *lib, const hn_args *args) {
    static const char *const deeds[] = {"check", "write"};
    const char *deed = args->words.word[0], *what = args->words.word[1];
    hn_diag diag;
    if (strcmp(deed, "check") == 0) {
        return check(lib, args, what, args->words.n > 2 ? args->words.word[2] : NULL);
    }
    if (strcmp(deed, "write") == 0 && args->words.n > 2) {
        hn_diag_set(&diag, HN_ERR_INPUT, NULL, "rubric write ID -o FILE",
                    "rubric write takes one exercise; '%.200s' is a second word",
                    args->words.word[2]);
        return hn_report_diag(args, &diag);
    }
    if (strcmp(deed, "write") == 0) {
        return write_rubric(lib, args, what);
    }
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, deed, deeds, 2, "rubric check FILE, rubric write ID");
    hn_diag_set(&diag, HN_ERR_INPUT, NULL, hint, "there is no command 'rubric %.40s'", deed);
    return hn_report_diag(args, &diag);
}

hn_status hn_cli_apply_rubric(const hn_args *args, hn_exercise *exercise, hn_diags *diags) {
    hn_rubric *rubric = NULL;
    if (!args->rubric) {
        return HN_OK;
    }
    hn_status status = hn_rubric_load_file(args->rubric, &rubric, diags);
    HN_THEN(status, hn_rubric_apply(rubric, exercise, diags));
    hn_rubric_sort_faults(diags);
    hn_diags_name_file(diags, 0, args->rubric);
    if (status != HN_OK) {
        hn_rubric_free(rubric);
    }
    return status;
}
