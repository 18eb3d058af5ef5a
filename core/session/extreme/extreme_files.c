// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_files.h"

#include "session/extreme/extreme_read.h"
#include "session/extreme/extreme_reader.h"

#include "base/file.h"
#include "base/folder.h"
#include "base/hash.h"
#include "base/json_text.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MOST_BYTES = 1 << 18, MOST_DEPTH = 20 };

static hn_extreme *make(const hn_library *lib) {
    hn_arena *arena = hn_arena_create(1 << 16);
    hn_extreme *x = arena ? hn_arena_get(arena, sizeof *x) : NULL;
    if (!x) {
        hn_arena_free(arena);
        return NULL;
    }
    memset(x, 0, sizeof *x);
    x->arena = arena;
    x->lib = lib;
    x->hash = HN_HASH_START;
    return x;
}

static hn_status add_case(hn_extreme *x, const char *file, const char *text, size_t n,
                          hn_diags *diags) {
    hn_diag diag;
    if (hn_json_text_check(text, n, MOST_DEPTH, &diag) != HN_OK) {
        return hn_diags_add(diags, diag.status, "", diag.hint, "%s: %s", file, diag.message);
    }
    hn_xr r = {
        .lib = x->lib, .arena = x->arena, .diags = diags, .file = file, .c = &x->cases[x->n_cases]};
    cJSON *root = cJSON_ParseWithLength(text, n);
    if (!root) {
        return HN_ERR_MEMORY;
    }
    hn_xr_case(&r, root);
    cJSON_Delete(root);
    x->hash = hn_hash_bytes(x->hash, text, n);
    x->n_cases += r.status == HN_OK;
    return r.status;
}

/// "x04-stiff-spring.json" is case x4.
static int number_of(const char *file) {
    int number = 0, used = 0;
    const size_t n = strlen(file);
    return n > 5 && strcmp(file + n - 5, ".json") == 0 &&
                   sscanf(file, "x%2d-%n", &number, &used) == 1 && used == 4
               ? number
               : 0;
}

static bool is_wanted(const char *file, const char *const *ids, int n_ids) {
    const int number = number_of(file);
    for (int i = 0; i < n_ids; i++) {
        if (tolower((unsigned char)ids[i][0]) == 'x' && atoi(ids[i] + 1) == number) {
            return true;
        }
    }
    return n_ids == 0;
}

static hn_status read_file(hn_extreme *x, const char *folder, const char *name, hn_diags *diags) {
    char path[4400];
    snprintf(path, sizeof path, "%.4096s/%.255s", folder, name);
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = hn_file_load(path, MOST_BYTES, &text, diags);
    HN_THEN(status, add_case(x, name, hn_strbuf_text(&text), text.n, diags));
    hn_strbuf_reset(&text);
    return status;
}

/// Writes "the cases are x1 to x25", by the files that are there.
static void name_cases(const hn_folder *cases, char hint[HN_DIAG_HINT]) {
    int first = 0, last = 0;
    for (int k = 0; k < cases->n; k++) {
        const int number = number_of(cases->names[k]);
        first = number > 0 && (first == 0 || number < first) ? number : first;
        last = number > last ? number : last;
    }
    snprintf(hint, HN_DIAG_HINT, "the cases are x%d to x%d", first, last);
}

/// Reports an id for which there is no file.
static hn_status check_ids(const hn_folder *cases, const char *const *ids, int n_ids,
                           hn_diags *diags) {
    for (int i = 0; i < n_ids; i++) {
        int found = 0;
        for (int k = 0; k < cases->n; k++) {
            found |= number_of(cases->names[k]) > 0 && is_wanted(cases->names[k], &ids[i], 1);
        }
        if (!found) {
            char hint[HN_DIAG_HINT];
            name_cases(cases, hint);
            return hn_diags_add(diags, HN_ERR_INPUT, "/id", hint, "there is no case '%.40s'",
                                ids[i]);
        }
    }
    return HN_OK;
}

hn_status hn_extreme_load(const hn_library *lib, const char *const *ids, int n_ids,
                          hn_extreme **out, hn_diags *diags) {
    char folder[4200];
    hn_folder cases = {0};
    hn_extreme *x = make(lib);

    // list the case files and check the names that were asked for
    snprintf(folder, sizeof folder, "%.4096s/extreme", hn_library_lessons(lib));
    hn_status status = x ? hn_folder_read(folder, &cases) : HN_ERR_MEMORY;
    status = status == HN_ERR_IO
                 ? hn_diags_add(diags, HN_ERR_IO, NULL, NULL, "there is no case in %s", folder)
             : status == HN_OK ? check_ids(&cases, ids, n_ids, diags)
                               : status;

    // read the wanted cases; a file with faults does not stop the others
    for (int i = 0; i < cases.n; i++) {
        const char *name = cases.names[i];
        if ((status == HN_OK || status == HN_ERR_INPUT) && x->n_cases < HN_EXTREME_CASES &&
            number_of(name) > 0 && is_wanted(name, ids, n_ids)) {
            const hn_status read = read_file(x, folder, name, diags);
            status = read == HN_OK ? status : read; // report the faults of all files
        }
    }
    hn_folder_reset(&cases);

    if (status != HN_OK) {
        hn_extreme_free(x);
        return status;
    }

    *out = x;
    return HN_OK;
}

void hn_extreme_free(hn_extreme *x) {
    if (x) {
        hn_journal_end(&x->journal, 0);
        hn_arena_free(x->arena);
    }
}
