// SPDX-License-Identifier: GPL-3.0-or-later
#define _XOPEN_SOURCE 700
#include "session/model/library.h"

#include "base/bundle.h"
#include "base/folder.h"
#include "base/suggest.h"
#include "session/model/installed.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_PATH_CHARS = 4096, MAX_ENTRIES = 512 };

enum { SCENES, PROBLEMS, N_SHELVES };
static const char *const folder_of[N_SHELVES] = {"scenes", "problems"};

/// Files of one kind, sorted by id.
typedef struct shelf {
    bool read; ///< its folders have been read
    int n;
    const char *ids[MAX_ENTRIES];
    const char *paths[MAX_ENTRIES];
} shelf;

/// Shelves that are read when a thread first asks for them: few commands need both
/// shelves.
typedef struct late {
    pthread_mutex_t lock;
    hn_arena *arena;
    shelf *shelves[N_SHELVES];
} late;

struct hn_library {
    hn_arena *arena;
    const char *web, *lessons;
    hn_folder folders; ///< in the folder of the lessons
    late *late;
};

/// Joins two parts; 0 if the result would not fit.
static bool join_path(char out[MAX_PATH_CHARS], const char *folder, const char *name) {
    int n = snprintf(out, MAX_PATH_CHARS, "%s/%s", folder, name);
    return n > 0 && n < MAX_PATH_CHARS;
}

/// Finds the folder of the running program, without a trailing slash; returns 0 if it is unknown.
static bool program_folder(char out[MAX_PATH_CHARS]) {
    ssize_t n = readlink("/proc/self/exe", out, MAX_PATH_CHARS - 1);
    if (n <= 0) {
        return false;
    }
    out[n] = 0;
    char *slash = strrchr(out, '/');
    if (!slash) {
        return false;
    }
    *slash = 0;
    return true;
}

static bool is_home(const char *folder) {
    char path[MAX_PATH_CHARS];
    return join_path(path, folder, "lessons") && hn_folder_exists(path) &&
           join_path(path, folder, "web") && hn_folder_exists(path);
}

/// Keeps a list of the places tried, for the message.
static void note_place(char *tried, size_t size, const char *folder) {
    size_t used = strlen(tried);
    snprintf(tried + used, size - used, "%s%s", used ? ", " : "", folder);
}

/// The folder that holds lessons/ and web/; 0 when there is none.
static int find_home(const char *home, char out[MAX_PATH_CHARS], char *tried, size_t n_tried) {
    // a folder that is named is the only one tried
    static const char *const beside[] = {"..", "../..", "../share/holonom"};
    const char *named = home ? home : getenv("HOLONOM_HOME");
    if (named && *named) {
        snprintf(out, MAX_PATH_CHARS, "%s", named);
        note_place(tried, n_tried, named);
        return is_home(out);
    }

    // otherwise: folders relative to the program, as built and as installed
    char program[MAX_PATH_CHARS];
    const bool is_known = program_folder(program);
    for (size_t i = 0; is_known && i < sizeof beside / sizeof *beside; i++) {
        char place[MAX_PATH_CHARS];
        if (!join_path(place, program, beside[i])) {
            continue;
        }
        char *real = realpath(place, NULL);
        if (!real) {
            continue;
        }
        note_place(tried, n_tried, real);
        snprintf(out, MAX_PATH_CHARS, "%s", real);
        free(real);
        if (is_home(out)) {
            return 1;
        }
    }

    // a program that only links the library: where make install put the files
    if (hn_installed_home[0]) {
        snprintf(out, MAX_PATH_CHARS, "%s", hn_installed_home);
        note_place(tried, n_tried, out);
        if (is_home(out)) {
            return 1;
        }
    }

    // a program that was copied alone has its own
    snprintf(out, MAX_PATH_CHARS, "%s", HN_BUNDLE);
    return is_home(out);
}

/// Puts one file on the shelf at its place in the order of ids; a second file of the same id is
/// left out.
static void shelve(hn_arena *arena, shelf *s, const char *folder, const char *file) {
    size_t n = strlen(file);
    char path[MAX_PATH_CHARS];
    if (n < 6 || strcmp(file + n - 5, ".json") != 0 || s->n == MAX_ENTRIES ||
        !join_path(path, folder, file)) {
        return;
    }

    // insertion sort by id; a second file of the same id is left out
    char id[256];
    snprintf(id, sizeof id, "%.*s", (int)(n - 5 < 255 ? n - 5 : 255), file);
    int at = s->n;
    while (at > 0 && strcmp(s->ids[at - 1], id) > 0) {
        at--;
    }
    if (at > 0 && strcmp(s->ids[at - 1], id) == 0) {
        return;
    }

    // make room and insert; without memory the file is left out
    const char *name = hn_arena_strdup(arena, id), *place = hn_arena_strdup(arena, path);
    if (!name || !place) {
        return;
    }
    memmove(s->ids + at + 1, s->ids + at, (size_t)(s->n - at) * sizeof *s->ids);
    memmove(s->paths + at + 1, s->paths + at, (size_t)(s->n - at) * sizeof *s->paths);
    s->ids[at] = name;
    s->paths[at] = place;
    s->n++;
}

static void read_folder(hn_arena *arena, shelf *s, const char *folder) {
    hn_folder files;
    if (hn_folder_read(folder, &files) != HN_OK) {
        return;
    }
    for (int i = 0; i < files.n; i++) {
        shelve(arena, s, folder, files.names[i]);
    }
    hn_folder_reset(&files);
}

/// The shelf of scenes or of problems, of every lesson; read by the first who asks.
static const shelf *get_shelf(const hn_library *lib, int kind) {
    late *at = lib->late;
    shelf *s = at->shelves[kind];
    pthread_mutex_lock(&at->lock);
    for (int i = 0; !s->read && i < lib->folders.n; i++) {
        char lesson[MAX_PATH_CHARS], folder[MAX_PATH_CHARS];
        if (join_path(lesson, lib->lessons, lib->folders.names[i]) &&
            join_path(folder, lesson, folder_of[kind])) {
            read_folder(at->arena, s, folder);
        }
    }
    s->read = true;
    pthread_mutex_unlock(&at->lock);
    return s;
}

/// Room for the shelves. Fails: HN_ERR_MEMORY.
static hn_status create_late(hn_library *lib) {
    late *at = hn_arena_get(lib->arena, sizeof *at);
    for (int i = 0; at && i < N_SHELVES; i++) {
        at->shelves[i] = hn_arena_get(lib->arena, sizeof *at->shelves[i]);
    }
    if (hn_arena_failed(lib->arena)) {
        return HN_ERR_MEMORY;
    }
    at->arena = lib->arena;
    lib->late = at;
    return pthread_mutex_init(&at->lock, NULL) == 0 ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_library_open(const char *home, hn_library **out, hn_diag *diag) {
    char folder[MAX_PATH_CHARS] = "", tried[2 * MAX_PATH_CHARS] = "", path[MAX_PATH_CHARS];
    if (!find_home(home, folder, tried, sizeof tried)) {
        return hn_diag_set(diag, HN_ERR_IO, NULL,
                           "set HOLONOM_HOME to the folder that holds lessons/ and web/",
                           "no folder with lessons/ and web/ was found; tried: %.300s", tried);
    }

    // the library owns its strings
    hn_arena *arena = hn_arena_create(1 << 15);
    hn_library *lib = arena ? hn_arena_get(arena, sizeof *lib) : NULL;
    if (!lib) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    lib->arena = arena;
    if (join_path(path, folder, "web")) {
        lib->web = hn_arena_strdup(arena, path);
    }
    if (join_path(path, folder, "lessons")) {
        lib->lessons = hn_arena_strdup(arena, path);
    }

    // its scenes and problems later
    if (hn_arena_failed(arena) || create_late(lib) != HN_OK) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (!lib->web || !lib->lessons || hn_folder_read(lib->lessons, &lib->folders) != HN_OK) {
        const char *lessons = lib->lessons ? lib->lessons : folder;
        const hn_status status =
            hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "the folder %s cannot be read", lessons);
        hn_arena_free(arena);
        return status;
    }
    *out = lib;
    return HN_OK;
}

void hn_library_free(hn_library *lib) {
    if (lib) {
        hn_folder_reset(&lib->folders);
        pthread_mutex_destroy(&lib->late->lock);
        hn_arena_free(lib->arena);
    }
}

const char *hn_library_web(const hn_library *lib) {
    return lib->web;
}

const char *hn_library_lessons(const hn_library *lib) {
    return lib->lessons;
}

static const char *find_path(const shelf *s, const char *id) {
    for (int i = 0; i < s->n; i++) {
        if (strcmp(s->ids[i], id) == 0) {
            return s->paths[i];
        }
    }
    return NULL;
}

int hn_library_n_scenes(const hn_library *lib) {
    return get_shelf(lib, SCENES)->n;
}

const char *hn_library_scene_id(const hn_library *lib, int i) {
    return get_shelf(lib, SCENES)->ids[i];
}

const char *hn_library_scene_path(const hn_library *lib, const char *id) {
    return find_path(get_shelf(lib, SCENES), id);
}

const char *const *hn_library_scene_ids(const hn_library *lib) {
    return get_shelf(lib, SCENES)->ids;
}

hn_status hn_library_check_scene(const hn_library *lib, const char *id, const char *pointer,
                                 hn_diags *diags) {
    char hint[HN_DIAG_HINT];
    if (hn_library_scene_path(lib, id)) {
        return HN_OK;
    }
    hn_suggest(hint, id, hn_library_scene_ids(lib), hn_library_n_scenes(lib),
               "'holonom list scenes' names them all");
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, hint, "no shipped scene is called '%.80s'",
                        id);
}

const char *hn_library_problem_path(const hn_library *lib, const char *id) {
    return find_path(get_shelf(lib, PROBLEMS), id);
}

int hn_library_n_problems(const hn_library *lib) {
    return get_shelf(lib, PROBLEMS)->n;
}

const char *hn_library_problem_id(const hn_library *lib, int i) {
    return get_shelf(lib, PROBLEMS)->ids[i];
}
