// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/trial.h"

#include "support/near.h"
#include "dynamics/compile/compile.h"

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
