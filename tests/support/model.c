// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/model.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "support/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SETTINGS = 8 };

static void fail_with(const char *what, const hn_diags *diags) {
    const char *message = diags->n ? diags->item[0].message : "(no message)";
    fail_msg("%s: %s", what, message);
}

/// "a=1 b=2" into settings; `names` holds the text they point into.
static int parse_settings(const char *text, char *names, size_t size, hn_setting *out) {
    int n = 0;
    if (!text) {
        return 0;
    }
    assert_true(strlen(text) < size);
    memcpy(names, text, strlen(text) + 1);
    for (char *save = NULL, *word = strtok_r(names, " ", &save); word;
         word = strtok_r(NULL, " ", &save)) {
        char *equals = strchr(word, '=');
        assert_non_null(equals);
        assert_true(n < MAX_SETTINGS);
        *equals = '\0';
        out[n++] = (hn_setting){word, strtod(equals + 1, NULL)};
    }
    return n;
}

static void compile_and_assemble(hn_model *m) {
    hn_system_opts opts = hn_system_opts_default();
    if (hn_system_compile(m->scene, &opts, &m->sys, &m->diags) != HN_OK) {
        fail_with("compile", &m->diags);
    }
    m->info = hn_system_get_info(m->sys);
    m->arena = hn_arena_create(0);
    assert_non_null(m->arena);
    double **of_nv[] = {&m->q, &m->v, &m->a, &m->user_q, &m->user_v};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(m->arena, (size_t)m->info.nq);
    }
    m->lambda = hn_arena_doubles(m->arena, (size_t)m->info.nc);
    assert_false(hn_arena_failed(m->arena));
    m->status = hn_assemble(m->sys, 0, m->q, m->v, m->a, m->lambda, &m->assembly, &m->diags);
    hn_system_to_user(m->sys, m->q, m->user_q);
    hn_system_rates_to_user(m->sys, m->v, m->user_v);
}

void hn_model_begin(hn_model *m, const char *name, const char *settings) {
    static const char *const folders[] = {"lessons/01-closed-loops/scenes", "tests/scenes",
                                          "tests/reference", "lessons/11-cabinet/scenes",
                                          "lessons/09-space-and-drives/scenes"};
    char path[256], names[256];
    hn_setting set[MAX_SETTINGS];
    memset(m, 0, sizeof *m);
    int n = parse_settings(settings, names, sizeof names, set);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        (void)snprintf(path, sizeof path, "%s/%s.json", folders[i], name);
        FILE *file = fopen(path, "r");
        if (file) {
            (void)fclose(file);
            break;
        }
    }
    if (hn_scene_load_file(path, set, n, &m->scene, &m->diags) != HN_OK) {
        fail_with(path, &m->diags);
    }
    compile_and_assemble(m);
}

void hn_model_open_text(hn_model *m, const char *json, const char *settings) {
    char names[256];
    hn_setting set[MAX_SETTINGS];
    memset(m, 0, sizeof *m);
    int n = parse_settings(settings, names, sizeof names, set);
    if (hn_scene_load_json(json, strlen(json), "text", set, n, &m->scene, &m->diags) != HN_OK) {
        fail_with("load", &m->diags);
    }
    compile_and_assemble(m);
}

void hn_model_open_closed(hn_model *m, const char *name, const char *settings) {
    hn_model_begin(m, name, settings);
    if (m->status != HN_OK) {
        fail_with("assemble", &m->diags);
    }
}

void hn_model_close(hn_model *m) {
    hn_system_free(m->sys);
    hn_scene_free(m->scene);
    hn_arena_free(m->arena);
    memset(m, 0, sizeof *m);
}

int hn_model_user(const hn_model *m, const char *name) {
    int coordinate = hn_scene_find_coordinate(m->scene, name);
    for (int i = 0; i < m->info.n_user; i++) {
        if (hn_system_user_coordinate(m->sys, i) == coordinate) {
            return i;
        }
    }
    fail_msg("no coordinate %s", name);
    return -1;
}
