// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST = 4096, NAME = 256 }; ///< files that one look takes in; bytes of a name

typedef struct file {
    char name[NAME];
    struct timespec changed;
} file;

static int newest_first(const void *a, const void *b) {
    const file *x = a, *y = b;
    const bool same = x->changed.tv_sec == y->changed.tv_sec;
    return same ? (x->changed.tv_nsec < y->changed.tv_nsec) -
                      (x->changed.tv_nsec > y->changed.tv_nsec)
                : (x->changed.tv_sec < y->changed.tv_sec ? 1 : -1);
}

/// Takes in the regular files of an open folder. Returns how many.
static int take_in(DIR *folder, file *list) {
    int n = 0;
    const struct dirent *entry;
    while (n < MOST && (entry = readdir(folder)) != NULL) {
        struct stat st;
        const int length = snprintf(list[n].name, NAME, "%s", entry->d_name);
        if (length < NAME && fstatat(dirfd(folder), entry->d_name, &st, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(st.st_mode)) {
            list[n++].changed = st.st_mtim;
        }
    }
    return n;
}

/// A file that a study still writes may go too: the study ends as well without it.
static void remove_oldest(const char *path) {
    DIR *folder = opendir(path);
    file *list = folder ? malloc(MOST * sizeof *list) : NULL;
    if (list) {
        const int n = take_in(folder, list);
        qsort(list, (size_t)n, sizeof *list, newest_first);
        for (int i = HN_STUDY_FILES; i < n; i++) {
            (void)unlinkat(dirfd(folder), list[i].name, 0);
        }
    }
    free(list);
    if (folder) {
        closedir(folder);
    }
}

bool hn_study_folder_ready(const char *runs, char *out, size_t size) {
    struct stat st;
    if (!runs || snprintf(out, size, "%s/studies", runs) >= (int)size) {
        return false;
    }
    (void)mkdir(out, 0700);
    if (lstat(out, &st) != 0 || !S_ISDIR(st.st_mode) || access(out, W_OK | X_OK) != 0) {
        return false;
    }
    remove_oldest(out);
    return true;
}
