// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/output_file.h"

#include "base/file.h"
#include "cli/shell/args.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/print.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_FORMER = 1000 };

hn_exit hn_cli_replace_file(const hn_args *args, const char *path, hn_strbuf *bytes) {
    if (!path || strcmp(path, "-") == 0) {
        return hn_cli_print(bytes);
    }
    hn_diag diag = {0};
    hn_status status = HN_ERR_MEMORY;
    if (bytes->failed) {
        hn_diag_set(&diag, status, "/out", NULL, "cannot write '%.200s': %s", path,
                    hn_status_text(status));
    } else {
        status = hn_file_write(path, hn_strbuf_text(bytes), bytes->n, &diag);
    }

    // the fault is not in the input
    hn_strbuf_reset(bytes);
    if (status != HN_OK) {
        hn_report_diag(args, &diag);
        return HN_EXIT_PROGRAM;
    }
    return HN_EXIT_DONE;
}

bool hn_cli_is_content(const char *path, const hn_strbuf *bytes) {
    struct stat st;
    hn_strbuf old;
    hn_strbuf_init(&old);
    const bool same = stat(path, &st) == 0 && (size_t)st.st_size == bytes->n &&
                      hn_file_read(path, bytes->n + 1, &old, NULL) == HN_OK && old.n == bytes->n &&
                      memcmp(hn_strbuf_text(&old), hn_strbuf_text(bytes), old.n) == 0;
    hn_strbuf_reset(&old);
    return same;
}

enum { FORMER_NAME = 4200 };

/// Copies a file of `size` bytes to a name that is free.
static bool copy_former(const char *path, const char *name, size_t size) {
    hn_strbuf old;
    hn_strbuf_init(&old);
    const bool copied = hn_file_read(path, size + 1, &old, NULL) == HN_OK &&
                        hn_file_write(name, hn_strbuf_text(&old), old.n, NULL) == HN_OK;
    hn_strbuf_reset(&old);
    return copied;
}

/// Keeps the file at `path` under the first free name FILE.1, FILE.2, ..., which is written to
/// `name`.
static bool keep_former(const char *path, size_t size, char name[FORMER_NAME]) {
    for (int k = 1; k <= MOST_FORMER; k++) {
        if (snprintf(name, FORMER_NAME, "%s.%d", path, k) >= FORMER_NAME) {
            return false;
        }

        // a link is made only where there is no file, and the old name is replaced afterwards
        if (linkat(AT_FDCWD, path, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0) {
            return true;
        }
        if (errno != EEXIST) {
            // a file system without such links
            return copy_former(path, name, size);
        }
    }
    return false;
}

static hn_exit fail_to_keep(const hn_args *args, const char *path, hn_strbuf *bytes) {
    hn_diag diag = {0};
    hn_strbuf_reset(bytes);
    hn_diag_set(
        &diag, HN_ERR_IO, "/out", "choose another name",
        "'%.200s' has other contents that cannot be kept under another name, so it was not changed",
        path);
    hn_report_diag(args, &diag);
    return HN_EXIT_PROGRAM;
}

hn_exit hn_cli_write_file(const hn_args *args, const char *path, hn_strbuf *bytes) {
    struct stat st;
    char name[FORMER_NAME];
    if (bytes->failed || args->force || !path || strcmp(path, "-") == 0 || stat(path, &st) != 0 ||
        !S_ISREG(st.st_mode) || hn_cli_is_content(path, bytes)) {
        return hn_cli_replace_file(args, path, bytes);
    }
    if (!keep_former(path, (size_t)st.st_size, name)) {
        return fail_to_keep(args, path, bytes);
    }

    // the old file stays under its own name where the new one cannot be written
    const hn_exit result = hn_cli_replace_file(args, path, bytes);
    if (result != HN_EXIT_DONE) {
        unlink(name);
        return result;
    }
    hn_cli_note("holonom: the old contents of '%s' are kept in '%s'\n", path, name);
    return result;
}

/// Returns whether the file begins as a picture of this program does: a PNG of 8 bits with the
/// chunk sRGB first, or acTL of an animation, or an SVG with the attributes of its plots.
static bool is_own_picture(const char *path) {
    static const char png[] = "\x89PNG\r\n\x1a\n",
                      svg[] = "<svg xmlns=\"http://www.w3.org/2000/svg\" ";
    enum { DEPTH = 24, FIRST = 37, SECOND = 50 }; // bytes at which fields of a PNG stand
    char begins[400] = "";
    const size_t n = hn_file_begin(path, begins, sizeof begins - 1);
    if (n > SECOND + 4 && memcmp(begins, png, sizeof png - 1) == 0) {
        const bool still =
            memcmp(begins + FIRST, "sRGB\1", 5) == 0 && memcmp(begins + SECOND, "IDAT", 4) == 0;
        return memcmp(begins + DEPTH, "\10\2", 2) == 0 &&
               (still || memcmp(begins + FIRST, "acTL", 4) == 0);
    }
    const char *end = strchr(begins, '>'), *role = strstr(begins, "role=\"img\"");
    return strncmp(begins, svg, sizeof svg - 1) == 0 && role && end == role + 10;
}

hn_exit hn_cli_write_picture(const hn_args *args, const char *path, hn_strbuf *picture) {
    const bool own = strcmp(path, "-") != 0 && is_own_picture(path);
    return own ? hn_cli_replace_file(args, path, picture) : hn_cli_write_file(args, path, picture);
}

hn_status hn_cli_check_folder(const char *path, hn_diags *diags) {
    char folder[4096] = "";
    size_t n = path ? strlen(path) : 0;
    while (n > 1 && path[n - 1] == '/') {
        n--; // a folder that the command makes: it is made in another one
    }
    while (n > 0 && path[n - 1] != '/') {
        n--;
    }

    // the dot at the end tells a folder from a file
    const bool fits = n + 2 < sizeof folder;
    snprintf(folder, sizeof folder, "%.*s.", (int)n, path ? path : "");
    if (fits && access(folder, W_OK) == 0) {
        return HN_OK;
    }
    const char *why = !fits             ? "its name is too long"
                      : errno == ENOENT ? "there is no such folder"
                                        : strerror(errno);
    return hn_diags_add(diags, HN_ERR_INPUT, "/out", "make the folder, or choose another name",
                        "cannot write '%.200s': %s", path ? path : "", why);
}

hn_status hn_cli_check_file(const char *path, hn_diags *diags) {
    struct stat st;
    HN_TRY(hn_cli_check_folder(path, diags));
    if (stat(path, &st) != 0 || !S_ISDIR(st.st_mode)) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/out", "name a file in it, or choose another name",
                        "cannot write '%.200s': it is a folder", path);
}

/// Returns whether the file holds this text, to the byte.
static bool holds(const char *path, const hn_strbuf *text) {
    hn_strbuf there;
    hn_strbuf_init(&there);
    const bool same = hn_file_read(path, text->n, &there, NULL) == HN_OK && there.n == text->n &&
                      memcmp(hn_strbuf_text(&there), hn_strbuf_text(text), text->n) == 0;
    hn_strbuf_reset(&there);
    return same;
}

hn_status hn_cli_protect_work(const hn_args *args, const hn_strbuf *text, hn_diags *diags) {
    struct stat st;
    if (!args->out || strcmp(args->out, "-") == 0 || args->force || stat(args->out, &st) != 0 ||
        !S_ISREG(st.st_mode) || holds(args->out, text)) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/out",
                        "choose another name, or add --force to replace it",
                        "'%.200s' is there already and may be somebody's work", args->out);
}

int hn_cli_same_file(const char *a, const char *b) {
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

/// Refuses to write over the file `input`; NULL and standard input are no files.
static hn_status protect(const char *out, const char *input, hn_diags *diags) {
    if (!input || strcmp(input, "-") == 0 || !hn_cli_same_file(out, input)) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/out", "choose another name for --out",
                        "'%.200s' is the input '%.200s': it would be overwritten", out, input);
}

hn_status hn_cli_protect_inputs(const hn_args *args, hn_diags *diags) {
    struct stat st;
    if (!args->out || strcmp(args->out, "-") == 0 ||
        (stat(args->out, &st) == 0 && !S_ISREG(st.st_mode))) {
        return HN_OK;
    }
    for (int i = 0; i < args->words.n; i++) {
        HN_TRY(protect(args->out, args->words.word[i], diags));
    }
    return protect(args->out, args->loops, diags);
}
