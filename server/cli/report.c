#include "cli/cli.h"
#include "cli/plain.h"
#include "study/run/timing.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static hn_exit exit_of(hn_status status) {
    switch (status) {
    case HN_ERR_MEMORY:
    case HN_ERR_INTERNAL:
        return HN_EXIT_PROGRAM;
    default:
        return HN_EXIT_INPUT;
    }
}

static void tell(const hn_diag *d) {
    fprintf(stderr, "holonom: %s", d->message);
    if (d->pointer[0]) {
        fprintf(stderr, " (at %s", d->pointer);
        if (d->column > 0) {
            fprintf(stderr, ", column %d", d->column);
        }
        fputc(')', stderr);
    }
    fputc('\n', stderr);
    if (d->hint[0]) {
        fprintf(stderr, "         %s\n", d->hint);
    }
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
        return exit_of(status);
    }
    for (int i = 0; i < diags->n; i++) {
        tell(&diags->item[i]);
    }
    if (diags->n == 0) {
        fprintf(stderr, "holonom: %s\n", hn_status_text(status));
    }
    if (diags->found > diags->n) {
        fprintf(stderr, "holonom: and %d more\n", diags->found - diags->n);
    }
    return exit_of(status);
}

hn_exit hn_report_diag(const hn_args *args, const hn_diag *diag) {
    hn_diags diags = {.n = 1, .found = 1, .item = {*diag}};
    return hn_report_diags(args, diag->status, &diags);
}

hn_exit hn_cli_print(hn_strbuf *text) {
    int ok = !text->failed;
    if (ok) {
        ok = fwrite(hn_strbuf_text(text), 1, text->n, stdout) == text->n;
        if (ok && text->n > 0 && text->text[text->n - 1] != '\n') {
            ok = fputc('\n', stdout) != EOF;
        }
        ok = ok && fflush(stdout) == 0;
    }
    if (!ok) {
        fprintf(stderr, "holonom: %s\n",
                text->failed ? hn_status_text(HN_ERR_MEMORY) : strerror(errno));
    }
    hn_strbuf_reset(text);
    return ok ? HN_EXIT_DONE : HN_EXIT_PROGRAM;
}

hn_exit hn_cli_print_text(hn_strbuf *text) {
    if (!text->failed && hn_plain_wanted(getenv("LC_ALL"), getenv("LC_CTYPE"), getenv("LANG"))) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_add(&plain, hn_strbuf_text(text));
        hn_strbuf_reset(text);
        *text = plain;
    }
    return hn_cli_print(text);
}

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

/// As a person would say it.
static void put_left(double seconds) {
    if (seconds < 90) {
        fprintf(stderr, ", %.0f s left", seconds);
    } else if (seconds < 90 * 60) {
        fprintf(stderr, ", %.0f min left", seconds / 60);
    } else {
        fprintf(stderr, ", %.1f h left", seconds / 3600);
    }
}

/// What is done, and how long the rest will take if it goes on like this.
static void put_bar(const char *what, double share, double risen, double elapsed) {
    enum { WIDTH = 24 };
    const int done = (int)(WIDTH * (share < 0 ? 0 : share > 1 ? 1 : share));
    fprintf(stderr, "\r\033[K%s [%.*s%.*s] %3.0f %%", what, done, "########################",
            WIDTH - done, "........................", 100 * share);
    if (risen > 0.01) {
        put_left(elapsed * (1 - share) / risen);
    }
}

void hn_progress_tell(hn_progress *p, const char *what, double share) {
    static const double PATIENCE = 1, BETWEEN = 0.1; // [s]
    double t = hn_wall_seconds();
    if (p->started == 0) {
        p->started = t;
    }
    if (p->begun == 0 || share <= p->first) {
        p->begun = t;
        p->first = share;
    }
    if (t - p->started < PATIENCE || t - p->last < BETWEEN || !isatty(STDERR_FILENO)) {
        return;
    }
    put_bar(what, share, share - p->first, t - p->begun);
    fflush(stderr);
    p->last = t;
    p->shown = 1;
}

void hn_progress_end(hn_progress *p) {
    if (p->shown) {
        fputs("\r\033[K", stderr);
        p->shown = 0;
    }
}
