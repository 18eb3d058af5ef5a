// SPDX-License-Identifier: GPL-3.0-or-later
// holonom export: a mechanism as a program of its own, or as a model of another program.
#include "session/export/export.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/scene_word.h"
#include "session/export/mechanism.h"

#include <string.h>

/// Fails: HN_ERR_INPUT when options of a program are given with a format.
static hn_status check_format(const hn_args *args, hn_diags *diags) {
    const char *other = !args->format    ? NULL
                        : args->language ? "--language"
                        : args->method   ? "--method"
                        : args->blanks   ? "--blanks"
                        : args->style    ? "--style"
                        : args->solver   ? "--solver"
                                         : NULL;
    return other ? hn_diags_add(diags, HN_ERR_INPUT, "/format", "leave one of them out",
                                "--format writes the mechanism and %s a program: not both", other)
                 : HN_OK;
}

/// Fails: HN_ERR_INPUT for a loop file without a URDF, or one that would replace another file.
static hn_status check_loops(const hn_args *args, hn_diags *diags) {
    if (!args->loops) {
        return HN_OK;
    }
    if (!args->format) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/loops", "--format urdf --loops FILE",
                            "a loop file belongs to a URDF");
    }
    const char *scene = args->words.word[0];
    const bool is_taken =
        hn_cli_same_file(args->loops, scene) || (args->out && strcmp(args->loops, args->out) == 0);
    return is_taken ? hn_diags_add(diags, HN_ERR_INPUT, "/loops", "choose another name for --loops",
                                   "'%.200s' is the scene, or the file of --out", args->loops)
                    : HN_OK;
}

/// Fails: HN_ERR_INPUT for another word.
static hn_status check_style(const hn_args *args, hn_diags *diags) {
    if (!args->style || strcmp(args->style, "full") == 0 || strcmp(args->style, "skeleton") == 0) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/style", "full or skeleton",
                        "'%.40s' is not a style of export", args->style);
}

static hn_status write_program(const hn_library *lib, const hn_args *args, const hn_model *model,
                               hn_strbuf *b, hn_strbuf *remarks, hn_diags *diags) {
    hn_export_request request = {.language = args->language ? args->language : "python",
                                 .method = args->method,
                                 .solver = args->solver,
                                 .blanks = args->blanks,
                                 .skeleton = args->style && strcmp(args->style, "skeleton") == 0};
    const hn_status status = hn_model_export(b, model, lib, &request, diags);
    if (status == HN_OK && request.remark[0]) {
        hn_strbuf_printf(remarks, "the program does not take the steps of %s: %s\n", args->method,
                         request.remark);
    }
    return status;
}

hn_exit hn_command_export(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b, loops, left_out;
    hn_strbuf_init(&b);
    hn_strbuf_init(&loops);
    hn_strbuf_init(&left_out);
    hn_status status = hn_cli_check_folder(args->loops, &diags);
    HN_THEN(status, check_format(args, &diags));
    HN_THEN(status, check_loops(args, &diags));
    HN_THEN(status, check_style(args, &diags));
    HN_THEN(status, hn_cli_protect_inputs(args, &diags));
    HN_THEN(status, hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags));

    // the mechanism or a program
    if (status == HN_OK) {
        status = args->format ? hn_model_export_mechanism(&b, args->loops ? &loops : NULL,
                                                          &left_out, model, args->format, &diags)
                              : write_program(lib, args, model, &b, &left_out, &diags);
    }
    if (status == HN_OK && args->blanks) {
        status = hn_cli_protect_work(args, &b, &diags);
    }
    hn_model_free(model);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        hn_strbuf_reset(&loops);
        hn_strbuf_reset(&left_out);
        return hn_report_diags(args, status, &diags);
    }

    // into the file or onto standard output; then what is not in it
    hn_exit result = hn_cli_write_file(args, args->out, &b);
    if (result == HN_EXIT_DONE && args->loops) {
        result = hn_cli_write_file(args, args->loops, &loops);
    }
    if (result == HN_EXIT_DONE) {
        hn_cli_note_lines(&left_out);
    }
    hn_strbuf_reset(&loops);
    hn_strbuf_reset(&left_out);
    return result;
}
