// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/motion.h"
#include "formulations/list/formulation_list.h"

#include "support/near.h"

#include <math.h>

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

double hn_motion_acceleration_error(const hn_model *m, const char *formulation,
                                    const double *settings, const double *a) {
    const hn_formulation *form = hn_formulation_find(formulation);
    const int nq = m->info.nq, nv = m->info.nv;
    double *y = hn_arena_doubles(m->arena, (size_t)(nq + nv)),
           *ydot = hn_arena_doubles(m->arena, (size_t)(nq + nv)), worst = 0;
    void *self = NULL;
    hn_ode ode;
    hn_diag diag = {0};
    assert_false(hn_arena_failed(m->arena));
    assert_int_equal(form->create(m->sys, settings, m->arena, &self, &diag), HN_OK);
    assert_int_equal(form->set_state(self, 0, m->q, m->v, y), HN_OK);
    form->ode(self, &ode);
    assert_int_equal(ode.rhs(self, 0, y, ydot), HN_OK);
    for (int i = 0; i < nv; i++) {
        worst = fmax(worst, fabs(ydot[nq + i] - a[i]));
    }
    form->destroy(self);
    return worst;
}
