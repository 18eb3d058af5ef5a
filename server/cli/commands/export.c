// SPDX-License-Identifier: GPL-3.0-or-later
// holonom export: a mechanism as a program of its own.
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/scene_word.h"
#include "session/export/export.h"

hn_exit hn_command_export(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_cli_check_folder(args->out, &diags);
    HN_THEN(status, hn_cli_protect_inputs(args, &diags));
    HN_THEN(status, hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags));

    // the program, into the file or onto standard output
    if (status == HN_OK) {
        hn_export_request request = {.language = args->language ? args->language : "python",
                                     .method = args->method,
                                     .blanks = args->blanks};
        status = hn_model_export(&b, model, lib, &request, &diags);
    }
    hn_model_free(model);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }
    return hn_cli_write_file(args, args->out, &b);
}
