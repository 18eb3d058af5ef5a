#include "support/motion.h"

#include "support/near.h"

hn_run *hn_motion_start_at(const hn_model *m, const char *method, const double *q,
                           const double *v) {
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    if (hn_method_parse(method, &spec, &diag) != HN_OK) {
        fail_msg("%s: %s", method, diag.message);
    }
    hn_run_opts opts = hn_run_opts_default();
    if (hn_run_create(m->sys, &spec, q, v, &opts, &run, &diag) != HN_OK) {
        fail_msg("%s: %s", method, diag.message);
    }
    hn_run_watch(run, 1);
    return run;
}

hn_run *hn_motion_start(const hn_model *m, const char *method) {
    return hn_motion_start_at(m, method, m->q, m->v);
}

hn_sample hn_motion_at(hn_run *run, double t) {
    hn_sample sample = {0};
    if (hn_run_advance(run, t) != HN_OK) {
        fail_msg("stopped at t = %g: %s", hn_run_time(run), hn_run_get_summary(run).reason);
    }
    assert_int_equal(hn_run_sample(run, t, &sample), HN_OK);
    return sample;
}

hn_run_summary hn_motion_summary(const hn_model *m, const char *method, double t_end) {
    hn_run *run = hn_motion_start(m, method);
    (void)hn_run_advance(run, t_end);
    hn_run_summary summary = hn_run_get_summary(run);
    if (summary.status != HN_OK) {
        fail_msg("%s stopped at t = %g: %s", method, summary.t, summary.reason);
    }
    hn_run_free(run);
    return summary;
}
