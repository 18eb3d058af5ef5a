#include "support/trial.h"

#include "support/near.h"

void hn_trial_open(hn_trial *trial, const char *path) {
    hn_trial_open_with(trial, path, NULL, 0);
}

void hn_trial_open_with(hn_trial *trial, const char *path, const hn_setting *settings, int n) {
    hn_diags diags = {0};
    hn_assembly report;
    *trial = (hn_trial){0};
    if (hn_scene_load_file(path, settings, n, &trial->scene, &diags) != HN_OK ||
        hn_system_compile(trial->scene, NULL, &trial->sys, &diags) != HN_OK) {
        fail_msg("%s: %s", path, diags.item[0].message);
    }
    trial->info = hn_system_get_info(trial->sys);
    assert_true(trial->info.nq <= 64 && trial->info.nv <= 64);
    if (hn_assemble(trial->sys, 0, trial->q, trial->v, NULL, NULL, &report, &diags) != HN_OK) {
        fail_msg("%s: %s", path, diags.item[0].message);
    }
}

void hn_trial_close(hn_trial *trial) {
    hn_system_free(trial->sys);
    hn_scene_free(trial->scene);
}
