// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/diagnostics.h"

#include "base/visible.h"
#include "cli/shell/args.h"
#include "cli/shell/notes.h"
#include "cli/shell/print.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// An output that cannot be written is not the fault of the input.
static bool is_output(const hn_diags *diags) {
    return diags->n > 0 && diags->item[0].status == HN_ERR_IO &&
           strcmp(diags->item[0].pointer, "/out") == 0;
}

static hn_exit exit_of(hn_status status, const hn_diags *diags) {
    const int ours = status == HN_ERR_MEMORY || status == HN_ERR_INTERNAL || is_output(diags);
    return ours ? HN_EXIT_PROGRAM : HN_EXIT_INPUT;
}

static void tell(const hn_diag *d) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, "holonom: ");
    hn_visible_add(&b, d->message, true);
    if (d->pointer[0]) {
        hn_strbuf_add(&b, " (at ");
        hn_visible_add(&b, d->pointer, true);
        if (d->column > 0) {
            hn_strbuf_printf(&b, ", column %d", d->column);
        }
        hn_strbuf_add(&b, ")");
    }
    hn_strbuf_add(&b, "\n");
    if (d->hint[0]) {
        hn_strbuf_add(&b, "         ");
        hn_visible_add(&b, d->hint, true);
        hn_strbuf_add(&b, "\n");
    }
    hn_cli_note_lines(&b);
    hn_strbuf_reset(&b);
}

hn_exit hn_report_diags(const hn_args *args, hn_status status, const hn_diags *diags) {
    if (args && args->json) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_json_object(&b);
        hn_json_put_string(&b, "status", hn_status_name(status));
        hn_json_key(&b, "errors");
        hn_json_diags(&b, diags);
        hn_json_end_object(&b);
        hn_cli_print(&b);
        return exit_of(status, diags);
    }

    // sentences for people, the first fault first
    for (int i = 0; i < diags->n; i++) {
        tell(&diags->item[i]);
    }
    if (diags->n == 0) {
        hn_cli_note("holonom: %s\n", hn_status_text(status));
    }
    if (diags->found > diags->n) {
        hn_cli_note("holonom: and %d more\n", diags->found - diags->n);
    }
    return exit_of(status, diags);
}

hn_exit hn_report_diag(const hn_args *args, const hn_diag *diag) {
    hn_diags diags = {.n = 1, .found = 1, .item = {*diag}};
    return hn_report_diags(args, diag->status, &diags);
}
