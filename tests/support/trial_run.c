// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/trial.h"

hn_method_spec hn_trial_spec(const char *spelling) {
    hn_method_spec spec = {0};
    hn_diag diag = {0};
    if (hn_method_parse(spelling, &spec, &diag) != HN_OK) {
        fail_msg("%s: column %d: %s", spelling, diag.column, diag.message);
    }
    return spec;
}

hn_run *hn_trial_run(const hn_trial *trial, const char *spelling) {
    const hn_method_spec spec = hn_trial_spec(spelling);
    hn_diag diag = {0};
    hn_run *run = NULL;
    if (hn_run_create(trial->sys, &spec, trial->q, trial->v, NULL, &run, &diag) != HN_OK) {
        fail_msg("%s: %s", spelling, diag.message);
    }
    return run;
}
