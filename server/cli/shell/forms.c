// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/forms.h"

#include "base/word_list.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

int hn_path_ends_in(const char *path, const char *suffix) {
    const size_t n = strlen(path), m = strlen(suffix);
    return n > m && strcasecmp(path + n - m, suffix) == 0;
}

static int count(const hn_job_form *forms) {
    int n = 0;
    while (n < HN_JOB_FORMS && forms[n].suffix) {
        n++;
    }
    return n;
}

/// The form of a file of this name, or with this suffix; -1: there is none.
static int find(const hn_job_form *forms, const char *path) {
    for (int i = 0; i < count(forms); i++) {
        if (hn_path_ends_in(path, forms[i].suffix)) {
            return i;
        }
    }
    return -1;
}

hn_status hn_forms_check(const hn_job_form *forms, const hn_args *args, hn_diags *diags) {
    char hint[HN_DIAG_HINT] = "end it in ";
    const int n = count(forms);
    if (args->out && find(forms, args->out) < 0) {
        for (int i = 0; i < n; i++) {
            const size_t used = strlen(hint);
            snprintf(hint + used, sizeof hint - used, "%s%s",
                     i == 0       ? ""
                     : i == n - 1 ? " or "
                                  : ", ",
                     forms[i].suffix);
        }
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", hint,
                            "the ending of '%.200s' does not choose a form", args->out);
    }
    if (args->json && args->csv) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/csv", "take --out FILE.csv beside --json",
                            "standard output cannot be JSON and CSV at once");
    }
    return HN_OK;
}

hn_exit hn_forms_print(const hn_job_form *forms, hn_text_writer text, const hn_args *args,
                       const void *work) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->json || args->csv || !text) {
        forms[find(forms, args->csv ? "-.csv" : "-.json")].put(&b, work);
        return hn_cli_print(&b);
    }
    text(&b, work);
    return hn_cli_print_text(&b);
}

hn_exit hn_forms_write(const hn_job_form *forms, hn_text_writer text, const hn_args *args,
                       const void *work) {
    if (args->out) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        forms[find(forms, args->out)].put(&b, work);
        const hn_exit written = hn_cli_write_file(args, args->out, &b);
        if (written != HN_EXIT_DONE) {
            return written;
        }
    }
    return hn_forms_print(forms, text, args, work);
}
