// SPDX-License-Identifier: GPL-3.0-or-later
// holonom program: a starting point for a program of one's own, which runs as one more method.
#include "base/file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"

#include <stdio.h>
#include <string.h>

enum { LARGEST = 1 << 16, LONGEST_PATH = 4096 };

static const struct {
    const char *language, *suffix;
} STARTS[] = {{"python", "py"}, {"javascript", "js"}, {"octave", "m"}, {"c", "c"},
              {"cpp", "cpp"},   {"java", "java"},     {"julia", "jl"}};
enum { N_STARTS = sizeof STARTS / sizeof *STARTS };

static hn_status find_suffix(const char *language, const char **suffix, hn_diags *diags) {
    const char *names[N_STARTS];
    char list[HN_DIAG_HINT] = "", meant[HN_DIAG_HINT];
    for (int i = 0; i < N_STARTS; i++) {
        names[i] = STARTS[i].language;
        const size_t n = strlen(list);
        snprintf(list + n, sizeof list - n, "%s%s", i ? ", " : "there is one in ", names[i]);
        if (strcmp(language, names[i]) == 0) {
            *suffix = STARTS[i].suffix;
            return HN_OK;
        }
    }
    const char *near = hn_nearest_name(language, names, N_STARTS);
    snprintf(meant, sizeof meant, "did you mean '%s'?", near ? near : "");
    return hn_diags_add(diags, HN_ERR_INPUT, "/language", near ? meant : list,
                        "there is no starting point in '%.40s'", language);
}

hn_exit hn_command_program(const hn_library *lib, const hn_args *args) {
    hn_diags diags = {0};
    hn_strbuf b;
    char path[LONGEST_PATH];
    const char *suffix = "";
    hn_strbuf_init(&b);
    hn_status status = find_suffix(args->words.word[0], &suffix, &diags);
    if (status == HN_OK) {
        snprintf(path, sizeof path, "%.3900s/../core/export/start/mine.%s.txt",
                 hn_library_lessons(lib), suffix);
        status = hn_file_load(path, LARGEST, &b, &diags);
        HN_THEN(status, hn_cli_protect_work(args, &b, &diags));
    }
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }
    return hn_cli_write_file(args, args->out, &b);
}
