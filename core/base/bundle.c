// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/bundle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The files are a tar archive (POSIX ustar) between two symbols that the linker may not know.
extern const char hn_bundle_start[] __attribute__((weak));
extern const char hn_bundle_end[] __attribute__((weak));

enum {
    BLOCK = 512,
    NAME = 0,
    SIZE = 124,
    TYPE = 156,
    PREFIX = 345,
    LONGEST_NAME = 100,
    LONGEST_PREFIX = 155,
    LONGEST_PATH = LONGEST_NAME + LONGEST_PREFIX + 3
};

bool hn_bundle_is_path(const char *path) {
    return strncmp(path, HN_BUNDLE, strlen(HN_BUNDLE)) == 0;
}

/// One entry of the archive.
typedef struct entry {
    char path[LONGEST_PATH]; ///< "/web/index.html"
    const char *bytes;
    size_t n;
} entry;

/// Reads the file at `at` and returns the place of the next one; NULL behind the last.
static const char *read_entry(const char *at, entry *e) {
    while (at && hn_bundle_end - at >= BLOCK && at[NAME]) {
        const char *prefix = at + PREFIX;
        snprintf(e->path, sizeof e->path, "/%.*s%s%.*s", LONGEST_PREFIX, prefix,
                 prefix[0] ? "/" : "", LONGEST_NAME, at + NAME);
        e->bytes = at + BLOCK;
        e->n = strtoull(at + SIZE, NULL, 8);
        const bool is_file = at[TYPE] == '0' || at[TYPE] == 0;
        at += BLOCK + (e->n + BLOCK - 1) / BLOCK * BLOCK;
        if (is_file) {
            return at;
        }
    }
    return NULL;
}

/// Copies a path without its parts ".." and what they take back; false when it is too long.
static bool flatten(const char *path, char out[LONGEST_PATH]) {
    size_t n = 0;
    while (*path) {
        const size_t part = 1 + strcspn(path + 1, "/"); // with the slash before it
        if (part == 3 && memcmp(path, "/..", 3) == 0) {
            while (n > 0 && out[--n] != '/') {}
        } else if (n + part >= LONGEST_PATH) {
            return false;
        } else {
            memcpy(out + n, path, part);
            n += part;
        }
        path += part;
    }
    out[n] = 0;
    return true;
}

const void *hn_bundle_find(const char *path, size_t *n) {
    char flat[LONGEST_PATH];
    entry e;
    if (!hn_bundle_is_path(path) || !flatten(path + strlen(HN_BUNDLE), flat)) {
        return NULL;
    }
    for (const char *at = hn_bundle_start; (at = read_entry(at, &e)) != NULL;) {
        if (strcmp(e.path, flat) == 0) {
            *n = e.n;
            return e.bytes;
        }
    }
    return NULL;
}

void hn_bundle_each(bool (*see)(void *user, const char *path), void *user) {
    entry e;
    for (const char *at = hn_bundle_start; (at = read_entry(at, &e)) != NULL;) {
        if (!see(user, e.path)) {
            return;
        }
    }
}
