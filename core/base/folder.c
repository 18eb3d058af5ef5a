// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/folder.h"

#include "base/bundle.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// Adds a name of n characters at the end; false when memory is out.
static bool add_name(hn_folder *f, const char *name, size_t n) {
    char **longer = realloc(f->names, ((size_t)f->n + 1) * sizeof *longer);
    f->names = longer ? longer : f->names;
    char *copy = longer ? strndup(name, n) : NULL;
    if (copy) {
        f->names[f->n++] = copy;
    }
    return copy != NULL;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

void hn_folder_reset(hn_folder *f) {
    for (int i = 0; i < f->n; i++) {
        free(f->names[i]);
    }
    free(f->names);
    *f = (hn_folder){0};
}

// ---- inside the program ----

typedef struct bundle_look {
    const char *folder; ///< "/web"
    hn_folder *out;
    bool failed;
} bundle_look;

/// Takes the part behind the folder, up to the next slash, once.
static bool take_path(void *user, const char *path) {
    bundle_look *look = user;
    const size_t n_folder = strlen(look->folder);
    if (strncmp(path, look->folder, n_folder) != 0 || path[n_folder] != '/') {
        return true;
    }
    const char *name = path + n_folder + 1;
    const size_t n = strcspn(name, "/");
    for (int i = 0; i < look->out->n; i++) {
        if (strlen(look->out->names[i]) == n && memcmp(look->out->names[i], name, n) == 0) {
            return true;
        }
    }
    look->failed = name[0] != '.' && !add_name(look->out, name, n);
    return !look->failed;
}

static hn_status read_bundle(const char *path, hn_folder *out) {
    bundle_look look = {.folder = path + strlen(HN_BUNDLE), .out = out};
    hn_bundle_each(take_path, &look);
    return look.failed ? HN_ERR_MEMORY : out->n == 0 ? HN_ERR_IO : HN_OK;
}

// ---- on the disk ----

static hn_status read_disk(const char *path, hn_folder *out) {
    DIR *dir = opendir(path);
    bool room = true;
    if (!dir) {
        return HN_ERR_IO;
    }
    for (struct dirent *e = readdir(dir); e && room; e = readdir(dir)) {
        room = e->d_name[0] == '.' || add_name(out, e->d_name, strlen(e->d_name));
    }
    closedir(dir);
    return room ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_folder_read(const char *path, hn_folder *out) {
    *out = (hn_folder){0};
    const hn_status status =
        hn_bundle_is_path(path) ? read_bundle(path, out) : read_disk(path, out);
    if (status != HN_OK) {
        hn_folder_reset(out);
    } else if (out->n > 1) {
        qsort(out->names, (size_t)out->n, sizeof *out->names, compare_names);
    }
    return status;
}

bool hn_folder_exists(const char *path) {
    struct stat st;
    if (!hn_bundle_is_path(path)) {
        return stat(path, &st) == 0 && S_ISDIR(st.st_mode);
    }
    hn_folder f;
    const bool exists = hn_folder_read(path, &f) == HN_OK;
    hn_folder_reset(&f);
    return exists;
}
