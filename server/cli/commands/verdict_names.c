// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/verdict_names.h"

#include "cli/shell/output_file.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { MOST_FOLDERS = 64 };

/// Describes how much of a submission's path its verdict's name keeps.
typedef struct kept {
    int folders; ///< the last ones
    bool ending;
} kept;

void hn_verdict_names_reset(hn_verdict_names *names) {
    for (int i = 0; i < names->n; i++) {
        free(names->path[i]);
    }
    names->n = 0;
}

/// The path from the root, or as it was typed where there is no such file.
static const char *full_path(const char *path, char buffer[PATH_MAX]) {
    return realpath(path, buffer) ? buffer : path;
}

/// Returns where the last `folders` folders of a path begin; a path with fewer begins behind its
/// root.
static const char *begin_folders(const char *path, int folders) {
    const char *from = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    while (folders-- > 0 && from > path + 1) {
        for (from--; from > path && from[-1] != '/'; from--) {}
    }
    return from;
}

/// Adds the part of a submission's path that its verdict keeps. Dots that lead upwards do not leave
/// the folder of the verdicts.
static void put_name(hn_strbuf *b, const char *submission, kept keep) {
    char buffer[PATH_MAX];
    const char *path = keep.folders ? full_path(submission, buffer) : submission;
    const char *from = begin_folders(path, keep.folders), *name = begin_folders(path, 0);
    const char *dot = strrchr(name, '.');
    const size_t n = !keep.ending && dot && dot > name ? (size_t)(dot - from) : strlen(from);
    for (size_t i = 0; i < n; i++) {
        const int upwards = from[i] == '.' && i + 1 < n && from[i + 1] == '.';
        hn_strbuf_add_n(b, upwards ? "_" : from + i, 1);
    }
}

static hn_status put_paths(hn_verdict_names *names, const char *folder,
                           const char *const *submissions, int n, kept keep, int single) {
    hn_verdict_names_reset(names);
    for (int i = 0; i < n; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_strbuf_printf(&b, "%s/", folder);
        if (single && n == 1) {
            hn_strbuf_add(&b, "results");
        } else {
            put_name(&b, strcmp(submissions[i], "-") == 0 ? "submission" : submissions[i], keep);
        }
        names->path[i] = hn_strbuf_take(&b);
        if (!names->path[i]) {
            return HN_ERR_MEMORY;
        }
        names->n = i + 1;
    }
    return HN_OK;
}

/// The first pair with one name, capital letters ignored as some file systems do; 0 when there is
/// none.
static bool find_pair(const hn_verdict_names *names, int *first, int *second) {
    for (int i = 0; i < names->n; i++) {
        for (int k = 0; k < i; k++) {
            if (strcasecmp(names->path[i], names->path[k]) == 0) {
                *first = k;
                *second = i;
                return true;
            }
        }
    }
    return false;
}

static bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/// Makes the folders of a path, the last part being a file.
static hn_status make_folders(const char *path, hn_diags *diags) {
    char part[PATH_MAX];
    const size_t n = strlen(path);
    if (n >= sizeof part) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/out", NULL, "the path '%.200s' is too long",
                            path);
    }
    for (size_t i = 1; i < n; i++) {
        if (path[i] == '/') {
            snprintf(part, sizeof part, "%.*s", (int)i, path);
            const int made = mkdir(part, 0777), why = errno;
            if (made != 0 && why == EEXIST && !is_folder(part)) {
                return hn_diags_add(diags, HN_ERR_INPUT, "/out", "choose another name",
                                    "the folder '%.200s' is no folder", part);
            }
            if (made != 0 && why != EEXIST) {
                return hn_diags_add(diags, HN_ERR_IO, "/out", NULL,
                                    "cannot make the folder '%.200s': %s", part, strerror(why));
            }
        }
    }
    return HN_OK;
}

/// A verdict, or its picture, must not be one of the submissions.
static hn_status check_overwriting(const hn_verdict_names *names, const char *const *submissions,
                                   const char *ending, hn_diags *diags) {
    const char *const endings[] = {ending, "png"};
    for (int i = 0; i < names->n; i++) {
        for (int e = 0; e < 2; e++) {
            char path[PATH_MAX + 8];
            snprintf(path, sizeof path, "%s.%s", names->path[i], endings[e]);
            for (int k = 0; k < names->n; k++) {
                if (hn_cli_same_file(path, submissions[k])) {
                    return hn_diags_add(diags, HN_ERR_INPUT, "/out", "choose another folder",
                                        "the verdict '%.200s' would overwrite the submission",
                                        path);
                }
            }
        }
    }
    return HN_OK;
}

/// Returns whether --out names the file of one verdict itself, as results.json: its ending is the
/// form's, and no folder has this name.
static bool is_file_name(const char *out, const char *ending) {
    struct stat info;
    const size_t n = strlen(out), m = strlen(ending);
    const bool ends = n > m + 1 && out[n - m - 1] == '.' && strcmp(out + n - m, ending) == 0;
    return ends && !(stat(out, &info) == 0 && S_ISDIR(info.st_mode));
}

hn_status hn_verdict_names_choose(hn_verdict_names *names, const char *folder,
                                  const char *const *submissions, int n, const char *ending,
                                  int single, hn_diags *diags) {
    // as little of the path as keeps them apart
    int first = 0, second = 0, pair = 1;
    const bool file = n == 1 && is_file_name(folder, ending);
    if (file) {
        hn_verdict_names_reset(names);
        names->path[0] = strndup(folder, strlen(folder) - strlen(ending) - 1);
        names->n = names->path[0] != NULL;
        pair = 0;
        HN_TRY(names->n ? HN_OK : HN_ERR_MEMORY);
    }
    for (int k = 0; k <= 2 * MOST_FOLDERS + 1 && pair; k++) {
        const kept keep = {.folders = k % (MOST_FOLDERS + 1), .ending = k > MOST_FOLDERS};
        HN_TRY(put_paths(names, folder, submissions, n, keep, single));
        pair = find_pair(names, &first, &second);
    }
    if (pair) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, "give each submission once",
                            "'%.150s' and '%.150s' are one submission, or differ in capital "
                            "letters alone",
                            submissions[first], submissions[second]);
    }

    for (int i = 0; i < n; i++) {
        HN_TRY(make_folders(names->path[i], diags));
    }
    return check_overwriting(names, submissions, ending, diags);
}
