// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/best_scores.h"

#include "base/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_BYTES = 1 << 20, MOST_PATH = 400 };

// ---- the file ----

/// Makes the folders of a path above its last part; false: one could not be made.
static bool make_folders(char *path) {
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        const bool there = mkdir(path, 0700) == 0 || errno == EEXIST;
        *slash = '/';
        if (!there) {
            return false;
        }
    }
    return true;
}

/// Finds where the file is, whether it exists or not; false: the user has no folder for state.
static bool find_path(char out[MOST_PATH]) {
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    const bool own = state && state[0] == '/';
    if (!own && !(home && home[0] == '/')) {
        return false;
    }
    return snprintf(out, MOST_PATH, "%s%s/holonom/lessons.json", own ? state : home,
                    own ? "" : "/.local/state") < MOST_PATH;
}

/// Reads the file into *out, owned. NULL with HN_OK: there is none.
static hn_status read_scores(const char *path, cJSON **out, hn_diag *diag) {
    struct stat file;
    hn_strbuf text;
    *out = NULL;
    if (stat(path, &file) != 0 && errno == ENOENT) {
        return HN_OK;
    }
    hn_strbuf_init(&text);
    hn_status status = hn_file_read(path, MOST_BYTES, &text, diag);
    if (status == HN_OK) {
        *out = cJSON_Parse(hn_strbuf_text(&text));
        if (!cJSON_IsObject(*out)) {
            cJSON_Delete(*out);
            *out = NULL;
            status = hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s holds no scores", path);
        }
    }
    hn_strbuf_reset(&text);
    return status;
}

// ---- scores ----

cJSON *hn_best_scores_load(void) {
    char path[MOST_PATH];
    cJSON *scores = NULL;
    hn_diag diag = {0};
    return find_path(path) && read_scores(path, &scores, &diag) == HN_OK ? scores : NULL;
}

bool hn_best_scores_find(const cJSON *scores, const char *exercise, double *score, double *most) {
    const cJSON *solved = cJSON_GetObjectItemCaseSensitive(scores, "solved");
    const cJSON *one = cJSON_GetObjectItemCaseSensitive(solved, exercise);
    const cJSON *points = cJSON_GetObjectItemCaseSensitive(one, "score");
    const cJSON *all = cJSON_GetObjectItemCaseSensitive(one, "most");
    if (!cJSON_IsNumber(points) || !cJSON_IsNumber(all)) {
        return false;
    }
    *score = points->valuedouble;
    *most = all->valuedouble;
    return true;
}

/// Puts a score in place of the one that was there; false: no memory.
static bool put(cJSON *scores, const char *exercise, double score, double most) {
    cJSON *solved = cJSON_GetObjectItemCaseSensitive(scores, "solved");
    if (!cJSON_IsObject(solved)) {
        cJSON_DeleteItemFromObjectCaseSensitive(scores, "solved");
        solved = cJSON_AddObjectToObject(scores, "solved");
    }
    cJSON_DeleteItemFromObjectCaseSensitive(solved, exercise);
    cJSON *one = solved ? cJSON_AddObjectToObject(solved, exercise) : NULL;
    return one && cJSON_AddNumberToObject(one, "score", score) &&
           cJSON_AddNumberToObject(one, "most", most);
}

hn_status hn_best_scores_keep(const char *exercise, double score, double most, hn_diag *diag) {
    char path[MOST_PATH];
    double before, of;
    cJSON *scores = NULL;
    if (!find_path(path)) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "neither XDG_STATE_HOME nor HOME is set");
    }
    HN_TRY(read_scores(path, &scores, diag));
    if (hn_best_scores_find(scores, exercise, &before, &of) && before > score) {
        cJSON_Delete(scores);
        return HN_OK;
    }

    // the whole file is replaced, or nothing of it
    scores = scores ? scores : cJSON_CreateObject();
    char *text = put(scores, exercise, score, most) ? cJSON_Print(scores) : NULL;
    hn_status status = HN_OK;
    if (!text) {
        status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    } else if (!make_folders(path)) {
        status = hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "the folder of %s cannot be made", path);
    } else {
        status = hn_file_write(path, text, strlen(text), diag);
    }
    cJSON_free(text);
    cJSON_Delete(scores);
    return status;
}
