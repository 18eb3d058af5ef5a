// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/trial.h"

#include "dynamics/compile/compile.h"
#include "support/near.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static void compile_and_assemble(hn_trial *trial, const char *what, hn_diags *diags) {
    hn_assembly report;
    if (hn_system_compile(trial->scene, NULL, &trial->sys, diags) != HN_OK) {
        fail_msg("%s: %s", what, diags->item[0].message);
    }
    trial->info = hn_system_get_info(trial->sys);
    assert_true(trial->info.nq <= 64 && trial->info.nv <= 64);
    if (hn_assemble(trial->sys, 0, trial->q, trial->v, NULL, NULL, &report, diags) != HN_OK) {
        fail_msg("%s: %s", what, diags->item[0].message);
    }
}

void hn_trial_open_with(hn_trial *trial, const char *path, const hn_setting *settings, int n) {
    hn_diags diags = {0};
    *trial = (hn_trial){0};
    if (hn_scene_load_file(path, settings, n, &trial->scene, &diags) != HN_OK) {
        fail_msg("%s: %s", path, diags.item[0].message);
    }
    compile_and_assemble(trial, path, &diags);
}

void hn_trial_open(hn_trial *trial, const char *path) {
    hn_trial_open_with(trial, path, NULL, 0);
}

void hn_trial_open_text(hn_trial *trial, const char *json) {
    hn_diags diags = {0};
    *trial = (hn_trial){0};
    if (hn_scene_load_json(json, strlen(json), "text", NULL, 0, &trial->scene, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    compile_and_assemble(trial, "text", &diags);
}

void hn_trial_close(hn_trial *trial) {
    hn_system_free(trial->sys);
    hn_scene_free(trial->scene);
}

enum { RANDOM_CORNERS = 40, MOST_PARAMETERS = 20 };

/// Settings of trial number k: the first ones draw an end for every parameter, the others take one
/// parameter to one of its ends. Returns how many.
static int settings_of_trial(const hn_scene *scene, int trial, unsigned *seed,
                             hn_setting settings[MOST_PARAMETERS]) {
    int n = 0;
    assert_true(scene->n_params <= MOST_PARAMETERS);
    for (int k = 0; k < scene->n_params; k++) {
        const hn_param *p = &scene->params[k];
        *seed = *seed * 1664525u + 1013904223u;
        const bool drawn = trial < RANDOM_CORNERS;
        const int end = drawn ? (int)(*seed >> 30 & 1) : trial & 1;
        if (p->max < HUGE_VAL && (drawn || k == (trial - RANDOM_CORNERS) / 2)) {
            settings[n++] = (hn_setting){p->name, end ? p->max : p->min};
        }
    }
    return n;
}

void hn_trial_try_ranges(const char *path) {
    unsigned seed = 7;
    hn_trial plain;
    hn_trial_open(&plain, path);
    for (int k = 0; k < RANDOM_CORNERS + 2 * plain.scene->n_params; k++) {
        hn_setting settings[MOST_PARAMETERS];
        const int n = settings_of_trial(plain.scene, k, &seed, settings);
        hn_trial corner;
        hn_trial_open_with(&corner, path, settings, n);
        hn_trial_close(&corner);
    }
    hn_trial_close(&plain);
}

int hn_trial_coordinate(const hn_trial *trial, const char *name) {
    for (int i = 0; i < trial->info.n_user; i++) {
        const hn_coordinate *c =
            &trial->scene->coordinates[hn_system_user_coordinate(trial->sys, i)];
        if (strcmp(c->name, name) == 0 || strcmp(c->rate, name) == 0) {
            return i;
        }
    }
    fail_msg("no coordinate %s", name);
    return -1;
}

void hn_trial_check_counts(const hn_trial_count *known, size_t n) {
    for (size_t i = 0; i < n; i++) {
        hn_trial trial;
        hn_trial_open(&trial, known[i].scene);
        hn_assembly report;
        assert_int_equal(hn_assemble(trial.sys, 0, trial.q, trial.v, NULL, NULL, &report, NULL),
                         HN_OK);
        assert_int_equal(report.freedoms, known[i].freedoms);
        assert_int_equal(report.rank, known[i].rank);
        assert_int_equal(trial.info.nc, known[i].rows);
        hn_trial_close(&trial);
    }
}
