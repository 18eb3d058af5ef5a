#include "cli/shell/output_file.h"

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
    FILE *f = bytes->failed ? NULL : fopen(path, "wb");
    if (!f) {
        hn_diag_set(&diag, bytes->failed ? HN_ERR_MEMORY : HN_ERR_IO, NULL, NULL,
                    "cannot write '%.200s': %s", path,
                    bytes->failed ? hn_status_text(HN_ERR_MEMORY) : strerror(errno));
        hn_strbuf_reset(bytes);
        return hn_report_diag(args, &diag);
    }
    int ok = fwrite(hn_strbuf_text(bytes), 1, bytes->n, f) == bytes->n;
    ok = fclose(f) == 0 && ok;
    hn_strbuf_reset(bytes);
    if (!ok) {
        hn_diag_set(&diag, HN_ERR_IO, NULL, NULL, "cannot write '%.200s': %s", path,
                    strerror(errno));
        return hn_report_diag(args, &diag);
    }
    return HN_EXIT_DONE;
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
