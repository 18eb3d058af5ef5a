// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/roster.h"

#include "base/file.h"
#include "class/submitters.h"
#include "class/zip_file.h"
#include "grade/student_name.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { MOST_DEPTH = 6, MOST_ARCHIVE = 64 << 20 };

// ---- names ----

static bool ends_in(const char *text, const char *ending) {
    const size_t n = strlen(text), m = strlen(ending);
    return n > m && strcasecmp(text + n - m, ending) == 0;
}

static bool is_number(const char *text, size_t n) {
    size_t digits = 0;
    while (digits < n && isdigit((unsigned char)text[digits])) {
        digits++;
    }
    return n > 0 && digits == n;
}

/// Canvas: NAME_[LATE_]NUMBER_NUMBER_file. Returns the length of the name, 0: it is not so.
static size_t canvas_name(const char *name) {
    const size_t first = strcspn(name, "_");
    const char *p = name[first] ? name + first + 1 : "";
    if (strncmp(p, "LATE_", 5) == 0) {
        p += 5;
    }
    for (int i = 0; i < 2; i++) {
        const size_t n = strcspn(p, "_");
        if (!p[n] || !is_number(p, n)) {
            return 0;
        }
        p += n + 1;
    }
    return first;
}

/// Takes the student's name from the name of a folder or file, by the rules of roster.h.
static void find_student(const char *name, char out[HN_ROSTER_NAME]) {
    const char *moodle = strstr(name, "_assignsubmission_");
    const char *dot = strrchr(name, '.');
    size_t n = canvas_name(name);
    if (moodle) {
        // behind the name stands the participant's number
        n = (size_t)(moodle - name);
        size_t digits = n;
        while (digits > 0 && isdigit((unsigned char)name[digits - 1])) {
            digits--;
        }
        n = digits < n && digits > 1 && name[digits - 1] == '_' ? digits - 1 : n;
    } else if (n == 0) {
        const bool file = ends_in(name, ".json") || ends_in(name, ".zip");
        n = file && dot ? (size_t)(dot - name) : strlen(name);
    }
    snprintf(out, HN_ROSTER_NAME, "%.*s", (int)(n < HN_ROSTER_NAME ? n : HN_ROSTER_NAME - 1), name);
}

// ---- the folder ----

static int compare(const void *a, const void *b) {
    const hn_roster_entry *x = a, *y = b;
    const int by_student = strcmp(x->student, y->student);
    return by_student ? by_student : strcmp(x->path, y->path);
}

/// Files of tools and systems that nobody hands in on purpose.
static bool is_noise(const char *name) {
    static const char *const noise[] = {"__MACOSX",
                                        "package.json",
                                        "submission_metadata.json",
                                        "submission_metadata.yml",
                                        "node_modules",
                                        "desktop.ini",
                                        "Thumbs.db"};
    for (size_t i = 0; i < sizeof noise / sizeof *noise; i++) {
        if (strcmp(name, noise[i]) == 0) {
            return true;
        }
    }
    return name[0] == '.';
}

/// `student`: who it is by a list of the platform; NULL: the name of the entry says it.
static hn_status add(hn_roster *r, const char *folder, const char *name, const char *student,
                     hn_diag *diag) {
    struct stat info;

    // room for one more
    if (r->n == r->cap) {
        const int cap = r->cap ? 2 * r->cap : 64;
        hn_roster_entry *larger = realloc(r->entry, (size_t)cap * sizeof *larger);
        if (!larger) {
            return HN_ERR_MEMORY;
        }
        r->entry = larger;
        r->cap = cap;
    }

    // whatever it is, it gets its row
    hn_roster_entry *e = &r->entry[r->n];
    const int n = snprintf(e->path, sizeof e->path, "%s/%s", folder, name);
    if (n >= (int)sizeof e->path) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "move the folder to a shorter path",
                           "the path of '%.200s' has more than %d bytes", name, HN_ROSTER_PATH - 1);
    }
    e->is_folder = lstat(e->path, &info) == 0 && S_ISDIR(info.st_mode);
    find_student(name, e->student);
    if (student) {
        hn_student_name_normalise(student, e->student, sizeof e->student);
        r->n++;
        return HN_OK;
    }

    // a file of another kind loses its ending too
    char *dot = strrchr(e->student, '.');
    if (!e->is_folder && dot && dot > e->student && strcmp(e->student, name) == 0) {
        *dot = '\0';
    }
    hn_student_name_normalise(e->student, e->student, sizeof e->student);
    r->n++;
    return HN_OK;
}

hn_status hn_roster_read(hn_roster *r, const char *folder, hn_diag *diag) {
    *r = (hn_roster){0};
    DIR *dir = opendir(folder);
    if (!dir) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "unpack the platform's archive first",
                           "'%.200s' is not a folder: %s", folder, strerror(errno));
    }

    // all but hidden entries and noise
    hn_submitters submitters;
    hn_status status = hn_submitters_read(&submitters, folder, diag);
    for (struct dirent *d; status == HN_OK && (d = readdir(dir)) != NULL;) {
        if (!is_noise(d->d_name)) {
            status = add(r, folder, d->d_name, hn_submitters_find(&submitters, d->d_name), diag);
        }
    }
    closedir(dir);
    hn_submitters_reset(&submitters);
    if (status == HN_OK && r->n == 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "a folder, a .json or a .zip for each student",
                           "there is nobody in '%.200s'", folder);
    }

    // by student, so that the order does not hang on the file system
    if (r->n > 0) {
        qsort(r->entry, (size_t)r->n, sizeof *r->entry, compare);
    }
    return status;
}

void hn_roster_reset(hn_roster *r) {
    free(r->entry);
    *r = (hn_roster){0};
}

// ---- one student's file ----

/// Endings of what is handed in, and how messages name it.
static const struct {
    const char *endings[7], *name, *hint;
} KINDS[] = {[HN_ROSTER_ANSWERS] = {{".json"}, "JSON file", "hand in one file that ends in .json"},
             [HN_ROSTER_PROGRAMS] = {{".py", ".c", ".cpp", ".java", ".m", ".jl"},
                                     "program",
                                     "hand in the one file that export --blanks wrote, filled in"}};

static bool is_kind(const char *name, hn_roster_kind kind) {
    bool found = false;
    for (const char *const *ending = KINDS[kind].endings; *ending; ending++) {
        found |= ends_in(name, *ending);
    }
    return found;
}

/// The files of a kind and the zip files below a folder: how many, and the first of each by name.
typedef struct finds {
    hn_roster_kind kind;
    int n_file, n_zip, n_other;
    char file[HN_ROSTER_PATH], zip[HN_ROSTER_PATH];
    char other[HN_ROSTER_PATH]; ///< of the files that are neither
} finds;

static void keep(int *n, char first[HN_ROSTER_PATH], const char *path) {
    if (++*n == 1 || strcmp(path, first) < 0) {
        snprintf(first, HN_ROSTER_PATH, "%s", path);
    }
}

static void search(finds *f, const char *folder, int depth) {
    DIR *dir = depth < MOST_DEPTH ? opendir(folder) : NULL;
    if (!dir) {
        return;
    }

    // links are not followed: lstat() shows them as neither file nor folder
    for (struct dirent *d; (d = readdir(dir)) != NULL;) {
        char path[HN_ROSTER_PATH];
        struct stat info;
        if (is_noise(d->d_name) ||
            snprintf(path, sizeof path, "%s/%s", folder, d->d_name) >= (int)sizeof path ||
            lstat(path, &info) != 0) {
            continue;
        }

        if (S_ISDIR(info.st_mode)) {
            search(f, path, depth + 1);
        } else if (S_ISREG(info.st_mode) && is_kind(path, f->kind)) {
            keep(&f->n_file, f->file, path);
        } else if (S_ISREG(info.st_mode) && ends_in(path, ".zip")) {
            keep(&f->n_zip, f->zip, path);
        } else {
            keep(&f->n_other, f->other, path);
        }
    }
    closedir(dir);
}

/// "no JSON file was handed in, only 'answer.json.txt' and 2 other files".
static hn_status refuse_others(const finds *f, hn_diag *diag) {
    char others[40] = "";
    if (f->n_other > 1) {
        snprintf(others, sizeof others, " and %d other file%s", f->n_other - 1,
                 f->n_other > 2 ? "s" : "");
    }
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, KINDS[f->kind].hint,
                       "no %s was handed in, only '%.100s'%s", KINDS[f->kind].name,
                       strrchr(f->other, '/') + 1, others);
}

static hn_status refuse_count(int n, hn_roster_kind kind, hn_diag *diag) {
    const char *name = KINDS[kind].name, *hint = KINDS[kind].hint;
    return n == 0 ? hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "no %s was handed in", name)
                  : hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                                "%d %ss were handed in; which one counts cannot be told", n, name);
}

static bool is_answer(const char *name, hn_roster_kind kind) {
    const char *base = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
    return is_kind(name, kind) && !is_noise(base) && strstr(name, "__MACOSX") == NULL;
}

static hn_status load_zip(const char *path, hn_roster_kind kind, hn_strbuf *text,
                          char file[HN_ROSTER_PATH], hn_diag *diag) {
    hn_strbuf bytes;
    hn_zip_entry *list = NULL;
    int n = 0, found = 0, one = 0;
    hn_strbuf_init(&bytes);

    // the one answer among the files of the archive
    hn_status status = hn_file_read(path, MOST_ARCHIVE, &bytes, diag);
    HN_THEN(status, hn_zip_list(hn_strbuf_text(&bytes), bytes.n, &list, &n, diag));
    for (int i = 0; status == HN_OK && i < n; i++) {
        if (is_answer(list[i].name, kind)) {
            found++;
            one = i;
        }
    }
    if (status == HN_OK && found != 1) {
        status = refuse_count(found, kind, diag);
    }

    // the answer itself
    if (status == HN_OK) {
        snprintf(file, HN_ROSTER_PATH, "%.700s:%.255s", path, list[one].name);
        status =
            hn_zip_read(hn_strbuf_text(&bytes), bytes.n, &list[one], HN_ROSTER_BYTES, text, diag);
    }

    free(list);
    hn_strbuf_reset(&bytes);
    return status;
}

/// A file that is no submission: a link, or of another kind than is handed in.
static hn_status check_file(const char *path, hn_roster_kind kind, hn_diag *diag) {
    struct stat info;
    const char *name = strrchr(path, '/') + 1;
    const char *hint = KINDS[kind].hint;
    if (lstat(path, &info) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "'%.100s' cannot be read: %s", name,
                           strerror(errno));
    }
    if (S_ISLNK(info.st_mode)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                           "'%.100s' is a link; links are not followed", name);
    }
    if (!S_ISREG(info.st_mode) || !(is_kind(name, kind) || ends_in(name, ".zip"))) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                           "'%.100s' is no %s, no .zip archive and no folder", name,
                           kind == HN_ROSTER_ANSWERS ? ".json file" : KINDS[kind].name);
    }
    return HN_OK;
}

hn_status hn_roster_load(const hn_roster_entry *e, hn_roster_kind kind, hn_strbuf *text,
                         char file[HN_ROSTER_PATH], hn_diag *diag) {
    finds f = {.kind = kind};
    snprintf(file, HN_ROSTER_PATH, "%s", e->path);
    if (!e->is_folder) {
        HN_TRY(check_file(e->path, kind, diag));
    }
    if (e->is_folder) {
        search(&f, e->path, 0);
    } else if (ends_in(e->path, ".zip")) {
        keep(&f.n_zip, f.zip, e->path);
    } else {
        keep(&f.n_file, f.file, e->path);
    }
    if (f.n_file == 0 && f.n_zip == 1) {
        return load_zip(f.zip, kind, text, file, diag);
    }
    if (f.n_file == 0 && f.n_zip == 0 && f.n_other > 0) {
        return refuse_others(&f, diag);
    }
    if (f.n_file != 1) {
        return refuse_count(f.n_file, kind, diag);
    }
    snprintf(file, HN_ROSTER_PATH, "%s", f.file);
    return hn_file_read(f.file, HN_ROSTER_BYTES, text, diag);
}
