// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/output_file.h"

#include "base/file.h"
#include "cli/shell/args.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/print.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

hn_exit hn_cli_write_file(const hn_args *args, const char *path, hn_strbuf *bytes) {
    if (!path || strcmp(path, "-") == 0) {
        return hn_cli_print(bytes);
    }
    hn_diag diag;
    const hn_status status =
        bytes->failed ? hn_diag_set(&diag, HN_ERR_MEMORY, NULL, NULL, "cannot write '%.200s': %s",
                                    path, hn_status_text(HN_ERR_MEMORY))
                      : hn_file_write(path, hn_strbuf_text(bytes), bytes->n, &diag);
    hn_strbuf_reset(bytes);
    return status == HN_OK ? HN_EXIT_DONE : hn_report_diag(args, &diag);
}

hn_status hn_cli_check_folder(const char *path, hn_diags *diags) {
    const char *slash = path ? strrchr(path, '/') : NULL;
    char folder[4096] = "";
    if (!slash || slash == path) {
        return HN_OK;
    }
    const int n = snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    if (n < (int)sizeof folder && access(folder, W_OK) == 0) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_IO, "/out", NULL, "cannot write '%.200s': %s", path,
                        n < (int)sizeof folder ? strerror(errno) : "its name is too long");
}
